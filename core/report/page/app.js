P.load().then(
  (report) => {
    document.getElementById("title").textContent = report.meta.title;
    const { word, sentences } = report.meta.verdict;
    document.getElementById("verdict").textContent = [word, ...sentences].join(" ");
  },
  (fault) => {
    document.getElementById("verdict").textContent = String(fault.message || fault);
  },
);
