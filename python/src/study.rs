//! `post._native.Study`: the jobs of a study, done on threads here, or by whoever asks for their lines.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Mutex;

use numpy::{IntoPyArray, PyArray1};
use post_job::library::{Refusal, StopSignal, StudyJobs, StudyPart, StudyValues};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::apart::apart;
use crate::options;

/// Whether to go on is asked of Python no oftener than a user would see.
struct ProgressCallback {
    told: Option<Py<PyAny>>,
    /// What stopped the work.
    fault: Option<PyErr>,
}

impl ProgressCallback {
    /// Hears signals and tells how far the work has come; false ends it.
    fn look(&mut self, done: usize, refused: usize) -> bool {
        Python::attach(|py| {
            let heard = py.check_signals().and_then(|()| match &self.told {
                Some(told) => told.call1(py, (done, refused)).map(drop),
                None => Ok(()),
            });
            match heard {
                Ok(()) => true,
                Err(fault) => {
                    self.fault = Some(fault);
                    false
                }
            }
        })
    }

    /// Raises what stopped the work.
    fn heard(self) -> PyResult<()> {
        self.fault.map_or(Ok(()), Err)
    }
}

/// The jobs of a study, and what came of them.
#[pyclass(module = "post._native", frozen)]
pub struct Study {
    jobs: Mutex<StudyJobs>,
}

impl Study {
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&StopSignal, &mut StudyJobs) -> Result<T, Refusal> + Send,
    ) -> PyResult<T> {
        apart(py, |stop| {
            // What a job that panicked left undone is done again.
            let mut jobs = self.jobs.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            job(stop, &mut jobs)
        })
    }
}

#[pymethods]
impl Study {
    #[new]
    fn new(
        py: Python<'_>,
        lines: &str,
        options: Vec<(String, options::OptionInput)>,
        journal: Option<PathBuf>,
    ) -> PyResult<Self> {
        let options = options::told(options);
        let jobs = apart(py, |stop| StudyJobs::new(stop, lines, &options, journal.as_deref()))?;
        Ok(Self { jobs: Mutex::new(jobs) })
    }

    /// How many jobs there are.
    fn count(&self, py: Python<'_>) -> PyResult<usize> {
        self.with(py, |_, jobs| Ok(jobs.count()))
    }

    /// The numbers of those that are not done.
    fn open(&self, py: Python<'_>) -> PyResult<Vec<usize>> {
        self.with(py, |_, jobs| Ok(jobs.open()))
    }

    /// CL file and line of each of these jobs.
    fn lines(&self, py: Python<'_>, numbers: Vec<usize>) -> PyResult<Vec<(String, String)>> {
        self.with(py, |_, jobs| {
            let lines = numbers.iter().filter_map(|number| jobs.job(*number));
            Ok(lines.map(|(file, line)| (file.to_owned(), line)).collect())
        })
    }

    /// The texts of all machines, to be handed over.
    fn machines(&self, py: Python<'_>) -> PyResult<String> {
        self.with(py, |_, jobs| Ok(jobs.machines()))
    }

    /// Does what is not done on so many threads.
    fn run(
        &self,
        py: Python<'_>,
        threads: Option<NonZeroUsize>,
        told: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        let mut looks = ProgressCallback { told, fault: None };
        let done = self.with(py, |stop, jobs| {
            jobs.run(threads, &mut |done, refused| !stop() && looks.look(done, refused))
        });
        looks.heard()?;
        done.map(drop)
    }

    /// Takes what `run_part` gave of these jobs; how many of them are not written.
    fn take(&self, py: Python<'_>, numbers: Vec<usize>, outcomes: Vec<String>) -> PyResult<usize> {
        self.with(py, |_, jobs| jobs.take(&numbers, &outcomes))
    }

    /// A job was lost with the process that did it.
    fn lost(&self, py: Python<'_>, number: usize, code: &str, message: &str) -> PyResult<()> {
        self.with(py, |_, jobs| jobs.lost(number, code, message))
    }

    /// The columns: numbers as float64, nan where there is none; counts as int64, or as float64 if one is missing; texts as
    /// lists with None.
    fn columns(&self, py: Python<'_>) -> PyResult<Vec<(String, Py<PyAny>)>> {
        let table = self.with(py, |_, jobs| Ok(jobs.table()))?;
        let columns = table.columns.into_iter().map(|column| {
            let values = match column.values {
                StudyValues::Numbers(numbers) => floats(py, numbers.into_iter()),
                StudyValues::Counts(counts) => {
                    match counts.iter().copied().collect::<Option<Vec<i64>>>() {
                        Some(counts) => counts.into_pyarray(py).into_any(),
                        None => {
                            let counts = counts.into_iter();
                            floats(py, counts.map(|count| count.map(|count| count as f64)))
                        }
                    }
                }
                StudyValues::Texts(texts) => texts.into_pyobject(py)?,
            };
            Ok((column.name, values.unbind()))
        });
        columns.collect()
    }

    /// The bytes of the table as a file whose name ends so.
    fn bytes<'py>(&self, py: Python<'py>, ending: &str) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let bytes = self.with(py, |_, jobs| Ok(jobs.table().bytes(ending)))?;
        Ok(bytes.map(|bytes| PyBytes::new(py, &bytes)))
    }

    /// Writes the table.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        self.with(py, |stop, jobs| jobs.write(stop, &path))
    }
}

fn floats(py: Python<'_>, numbers: impl Iterator<Item = Option<f64>>) -> Bound<'_, PyAny> {
    let numbers: Vec<f64> = numbers.map(|number| number.unwrap_or(f64::NAN)).collect();
    PyArray1::from_vec(py, numbers).into_any()
}

/// Does some jobs with texts that were handed over: a line of JSON for each, for `Study.take`.
#[pyfunction]
pub fn run_part(
    py: Python<'_>,
    lines: &str,
    options: Vec<(String, options::OptionInput)>,
    files: Vec<(String, Vec<u8>)>,
    machines: &str,
    threads: Option<NonZeroUsize>,
) -> PyResult<Vec<String>> {
    let mut looks = ProgressCallback { told: None, fault: None };
    let options = options::told(options);
    let outcomes = apart(py, |stop| {
        let part = StudyPart::new(stop, lines, &options, files, machines)?;
        part.run(threads, &mut |done, refused| !stop() && looks.look(done, refused))
    });
    looks.heard()?;
    Ok(outcomes?.unwrap_or_default())
}
