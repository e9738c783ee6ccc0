"""Puts into a copy of the book what is made by the command: `docs/site` calls it with the command and the copy."""

import re
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

CHECKOUT = Path(__file__).parents[1]
DATA = CHECKOUT.parent / "shared/data/cl"
PLAYGROUND = CHECKOUT / "editors/web/out/post.html"
LENGTH = "100"
"""Of the tool that the pictures of a machine have, mm."""


@dataclass
class Site:
    """The command, and the copy of the book."""

    command: Path
    book: Path

    def run(self, *words: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run([self.command, *words], cwd=CHECKOUT, capture_output=True, text=True)

    def told(self, *words: str | Path) -> str:
        """What the command prints; it must be good."""
        done = self.run(*words)
        if done.returncode:
            sys.exit(f"post {' '.join(map(str, words))}: {done.returncode}\n{done.stderr}")
        return done.stdout


def machines(site: Site) -> str:
    """A page for each machine of the library; the lines of the contents that name them."""
    pages = site.book / "src/library"
    pages.mkdir()
    rows, contents = [], ["- [The machine library](library/README.md)"]
    for file in sorted((CHECKOUT / "machines").glob("*.toml")):
        name = file.stem
        drawn = [f"--svg={pages / name}-reach.svg", f"--bodies={pages / name}-bodies.svg"]
        said = site.told("check", name, "--tool-length", LENGTH, *drawn)
        line = {words[0]: words[1].strip() for words in (row.split(None, 1) for row in said.splitlines()) if len(words) == 2}
        parts = [f"# {line['machine']}", "", f"`{name}`: {line['class']}.", ""]
        parts += ["```console", f"$ post check {name} --tool-length {LENGTH}", said.rstrip(), "```", ""]
        for what, text in (("reach", "Directions of the tool, seen from the part"), ("bodies", "Bodies, every axis at zero")):
            picture = pages / f"{name}-{what}.svg"
            if "no body has a shape" in picture.read_text():
                picture.unlink()
            else:
                parts += [f"![{text}]({picture.name})", ""]
        parts += ["## The file", "", "```toml", file.read_text().rstrip(), "```", ""]
        source = site.run("profile", name)
        if source.returncode == 0:
            parts += ["## Where its numbers come from", "", "```text", source.stdout.rstrip(), "```", ""]
        (pages / f"{name}.md").write_text("\n".join(parts))
        rows.append(f"| [{name}]({name}.md) | {line['class']} | {line['chain']} |")
        contents.append(f"  - [{name}](library/{name}.md)")
    head = "# The machine library\n\nMachines that come with `post`, as `post check` sees them. `post new` makes one of your own.\n\n"
    table = "| machine | class | chain |\n|---|---|---|\n" + "\n".join(rows) + "\n"
    (pages / "README.md").write_text(head + table)
    return "\n".join(contents)


def gallery(site: Site) -> int:
    """The reports of the six jobs, linked where the book shows them; how many."""
    page = site.book / "src/nc-programmer/six-jobs.md"
    text, made = page.read_text(), 0
    reports = site.book / "src/nc-programmer/reports"
    for block in re.findall(r"```sh\n(post .*?)\n```\n", text):
        words = shlex.split(block)[1:]
        file = DATA / words[0]
        if not file.is_file():
            found = list(DATA.rglob(words[0]))
            if not found:
                continue
            file = found[0]
        reports.mkdir(exist_ok=True)
        made += 1
        report = reports / f"{made}.html"
        words = [str(file), *words[1:], "-o", str(site.book / "part.nc")]
        words[words.index("--report") + 1] = str(report)
        site.told(*words, "-q")
        block_text = f"```sh\n{block}\n```\n"
        text = text.replace(block_text, f"{block_text}\n[Open its report](reports/{made}.html)\n")
    page.write_text(text)
    return made


def main() -> None:
    site = Site(*map(Path, sys.argv[1:3]))
    summary = site.book / "src/SUMMARY.md"
    text = summary.read_text()
    library = machines(site)
    text = text.replace("\n# Dialect and model author\n", f"\n{library}\n\n# Dialect and model author\n")
    if library not in text:
        sys.exit("SUMMARY.md has no part for authors of dialects")
    made = gallery(site)
    if made < 6:
        print(f"{6 - made} of the six jobs' reports are left out: their files are not in {DATA}", file=sys.stderr)
    if PLAYGROUND.is_file():
        shutil.copy(PLAYGROUND, site.book / "src/playground.html")
        page = site.book / "src/nc-programmer/browser.md"
        page.write_text(page.read_text().replace("\n\n", "\n\n**[Open it here](../playground.html)**\n\n", 1))
    else:
        print("the page of the browser is left out: editors/web/build makes it", file=sys.stderr)
    summary.write_text(text)


if __name__ == "__main__":
    main()
