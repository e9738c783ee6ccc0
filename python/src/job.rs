//! A program that was made, and what can be asked of it.

use std::path::PathBuf;

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1};
use post_job::library::{ColumnKind, KINDS, MadeProgram, ProgramFindings, REASONS, ReportOptions};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::apart::apart;
use crate::options;
use crate::refusal::{DiagnosticFields, told};

/// A program.
#[pyclass(frozen, module = "post._native")]
pub struct Job {
    pub made: MadeProgram,
}

#[pymethods]
impl Job {
    /// Its text.
    fn nc(&self) -> PyResult<&str> {
        let text = std::str::from_utf8(self.made.text());
        text.map_err(|fault| PyValueError::new_err(fault.to_string()))
    }

    /// What messages call it.
    fn name(&self) -> String {
        self.made.name()
    }

    /// Its summary, JSON.
    fn summary(&self) -> &str {
        self.made.summary()
    }

    /// What the user should know.
    fn warnings(&self) -> Vec<DiagnosticFields> {
        told(self.made.findings())
    }

    /// What was found when it is read back: JSON, and warnings.
    fn verify(&self, py: Python<'_>) -> PyResult<(String, Vec<DiagnosticFields>)> {
        apart(py, |stop| self.made.verify(stop)).map(given)
    }

    /// How near its bodies come to one another: JSON, and warnings.
    fn clearance(&self, py: Python<'_>) -> PyResult<(String, Vec<DiagnosticFields>)> {
        apart(py, |stop| self.made.clearance(stop)).map(given)
    }

    /// What is predicted: JSON, and warnings.
    fn predict(
        &self,
        py: Python<'_>,
        period: Option<f64>,
    ) -> PyResult<(String, Vec<DiagnosticFields>)> {
        apart(py, |stop| self.made.predict(stop, period)).map(given)
    }

    /// Writes its page.
    fn report(
        &self,
        py: Python<'_>,
        page: PathBuf,
        verify: bool,
        clearance: bool,
        predict: bool,
        most_megabytes: u64,
    ) -> PyResult<()> {
        let told = ReportOptions { verify, clearance, predict, most_megabytes };
        apart(py, |stop| self.made.report(stop, &page, told))
    }

    /// Its blocks as columns, if they were kept: arrays, names of axes, and what numbers of kinds, reasons and limits mean.
    fn blocks<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(blocks) = self.made.blocks() else {
            return Ok(None);
        };
        let all = PyDict::new(py);
        all.set_item("axes", blocks.axes.clone())?;
        all.set_item("kinds", KINDS)?;
        all.set_item("reasons", REASONS)?;
        all.set_item("limits", blocks.limits.clone())?;
        for array in &blocks.arrays {
            let (name, values) = (&array.name, &array.values);
            let whole = values.iter().map(|value| *value as i64);
            match (array.kind, array.width) {
                (ColumnKind::Count, _) => all.set_item(name, PyArray1::from_iter(py, whole)),
                (ColumnKind::Choice, _) => {
                    all.set_item(name, PyArray1::from_iter(py, whole.map(|place| place as u8)))
                }
                (ColumnKind::Flag, _) => {
                    all.set_item(name, PyArray1::from_iter(py, whole.map(|flag| flag != 0)))
                }
                (_, None) => all.set_item(name, PyArray1::from_slice(py, values)),
                (_, Some(width)) => {
                    let rows = Array2::from_shape_vec((blocks.rows, width), values.clone());
                    let rows = rows.map_err(|fault| PyValueError::new_err(fault.to_string()))?;
                    all.set_item(name, rows.into_pyarray(py))
                }
            }?;
        }
        Ok(Some(all))
    }
}

/// Posts the programs of a job file.
#[pyfunction]
pub fn job(
    py: Python<'_>,
    path: PathBuf,
    writes: bool,
    options: Vec<(String, options::OptionInput)>,
    keep_blocks: bool,
) -> PyResult<Vec<Job>> {
    let options = options::told(options);
    let post = |stop: &_| MadeProgram::of_job_file(stop, &path, writes, &options, keep_blocks);
    let made = apart(py, post)?;
    Ok(made.into_iter().map(|made| Job { made }).collect())
}

/// JSON and warnings of what was found.
pub fn given(found: ProgramFindings) -> (String, Vec<DiagnosticFields>) {
    (found.json, told(&found.findings))
}
