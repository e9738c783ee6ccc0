//! A program that was made, and what can be asked of it.

use std::path::PathBuf;

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1};
use post_job::library::{Found, KINDS, MadeProgram, REASONS, ReportTold};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::apart::apart;
use crate::refusal::{Told, told};

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
    fn warnings(&self) -> Vec<Told> {
        told(self.made.findings())
    }

    /// What was found when it is read back: JSON, and warnings.
    fn verify(&self, py: Python<'_>) -> PyResult<(String, Vec<Told>)> {
        apart(py, |stop| self.made.verify(stop)).map(given)
    }

    /// What is predicted: JSON, and warnings.
    fn predict(&self, py: Python<'_>, period: Option<f64>) -> PyResult<(String, Vec<Told>)> {
        apart(py, |stop| self.made.predict(stop, period)).map(given)
    }

    /// Writes its page.
    fn report(
        &self,
        py: Python<'_>,
        page: PathBuf,
        verify: bool,
        predict: bool,
        most_megabytes: u64,
    ) -> PyResult<()> {
        let told = ReportTold { verify, predict, most_megabytes };
        apart(py, |stop| self.made.report(stop, &page, told))
    }

    /// Its blocks as columns, if they were kept: arrays, names of axes, and what numbers of kinds, reasons and limits mean.
    fn blocks<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(blocks) = self.made.blocks() else {
            return Ok(None);
        };
        let all = PyDict::new(py);
        let table = |values: &[f64], width: usize| {
            let rows = Array2::from_shape_vec((blocks.len(), width), values.to_vec());
            let rows = rows.map_err(|fault| PyValueError::new_err(fault.to_string()))?;
            Ok::<_, PyErr>(rows.into_pyarray(py))
        };
        all.set_item("axes", blocks.axes.clone())?;
        all.set_item("kinds", KINDS)?;
        all.set_item("reasons", REASONS)?;
        all.set_item("limits", blocks.limits.clone())?;
        all.set_item("nc_line", PyArray1::from_slice(py, &blocks.nc_line))?;
        all.set_item("cl_line", PyArray1::from_slice(py, &blocks.cl_line))?;
        all.set_item("kind", PyArray1::from_slice(py, &blocks.kind))?;
        all.set_item("reason", PyArray1::from_slice(py, &blocks.reason))?;
        all.set_item("limit", PyArray1::from_slice(py, &blocks.limit))?;
        all.set_item("off_part", PyArray1::from_slice(py, &blocks.off_part))?;
        all.set_item("q", table(&blocks.q, blocks.axes.len())?)?;
        all.set_item("tip", table(&blocks.tip, 3)?)?;
        all.set_item("axis", table(&blocks.axis, 3)?)?;
        for (name, values) in [
            ("time_s", &blocks.time),
            ("way_mm", &blocks.way),
            ("tip_deviation_mm", &blocks.tip_deviation),
            ("axis_deviation_deg", &blocks.axis_deviation),
            ("feed_mm_min", &blocks.feed),
            ("asked_feed_mm_min", &blocks.asked_feed),
        ] {
            all.set_item(name, PyArray1::from_slice(py, values))?;
        }
        Ok(Some(all))
    }
}

fn given(found: Found) -> (String, Vec<Told>) {
    (found.json, told(&found.findings))
}
