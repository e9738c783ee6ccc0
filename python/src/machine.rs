//! A machine.

use std::path::PathBuf;

use numpy::ndarray::{Array1, Array2, Array3};
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArray3, PyReadonlyArray1, PyReadonlyArray2,
    PyUntypedArrayMethods,
};
use post_job::library::{
    Deviations, LoadedMachine, MachineSelection, MachineSettings, ReadTargets, Solutions,
    ToolPoses, VerifyOptions,
};
use post_machine::description::Setting;
use pyo3::prelude::*;

use crate::apart::{apart, at_once};
use crate::job::{Job, given};
use crate::options;
use crate::refusal::DiagnosticFields;

/// A machine with its settings, a tool in it.
#[pyclass(frozen, module = "post._native")]
pub struct Machine {
    loaded: LoadedMachine,
}

/// So many points are solved on the thread that asks: starting another takes longer than they do.
const AT_ONCE: usize = 256;

/// Numbers of many points.
type OutputRows<'py> = Bound<'py, PyArray2<f64>>;

/// Numbers of solutions of many points, and how many solutions each has.
type SolutionRows<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, PyArray1<i64>>);

/// Numbers of many points, in one piece.
type InputRows<'py> = PyReadonlyArray2<'py, f64>;

/// Of an axis its name, that it turns, that it carries the part, its unit and its travel.
type AxisDescription = (String, bool, bool, &'static str, Option<[f64; 2]>);

#[pymethods]
impl Machine {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "they are those of Machine.load")]
    fn new(
        py: Python<'_>,
        name: String,
        set: Vec<(String, String)>,
        tool_length: Option<f64>,
        mount: Option<[f64; 3]>,
        turn: Option<f64>,
        machines: Vec<PathBuf>,
        plugins: Vec<PathBuf>,
    ) -> PyResult<Self> {
        let set =
            set.iter().map(|(key, value)| Setting::Written(format!("{key}={value}"))).collect();
        let over = MachineSettings {
            set,
            mount,
            turn,
            tool_length,
            machines,
            plugins,
            ..Default::default()
        };
        let told = MachineSelection { name, over };
        let loaded = apart(py, |stop| LoadedMachine::load(stop, told))?;
        Ok(Self { loaded })
    }

    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        &self.loaded.description().name
    }

    /// Its axes, from the workpiece to the tool.
    fn axes(&self) -> Vec<AxisDescription> {
        let axes = self.loaded.kinematics().axes().into_iter();
        axes.map(|axis| (axis.name, axis.rotary, axis.carries_part, axis.unit, axis.travel))
            .collect()
    }

    /// The tool has a leading edge.
    #[getter]
    fn has_edge(&self) -> bool {
        self.loaded.kinematics().has_edge()
    }

    /// Where the axes stand before anything moves.
    fn start(&self) -> Vec<f64> {
        self.loaded.kinematics().start()
    }

    /// Tip and tool axis of axis values.
    fn forward<'py>(
        &self,
        py: Python<'py>,
        q: InputRows<'py>,
    ) -> PyResult<(OutputRows<'py>, OutputRows<'py>)> {
        let mut tip = Array2::zeros((q.shape()[0], 3));
        let mut axis = Array2::zeros((q.shape()[0], 3));
        let q = q.as_slice()?;
        if let (Some(tip), Some(axis)) = (tip.as_slice_mut(), axis.as_slice_mut()) {
            at_once(py, |_| {
                self.loaded.kinematics().forward(q, tip, axis);
                Ok(())
            })?;
        }
        Ok((tip.into_pyarray(py), axis.into_pyarray(py)))
    }

    /// All solutions for tips and tool axes, and how many each point has.
    fn inverse<'py>(
        &self,
        py: Python<'py>,
        tip: InputRows<'py>,
        axis: InputRows<'py>,
        edge: Option<InputRows<'py>>,
        near: PyReadonlyArray1<'py, f64>,
        within_travel: bool,
    ) -> PyResult<SolutionRows<'py>> {
        let points = tip.shape()[0];
        let wanted = ToolPoses {
            tip: tip.as_slice()?,
            axis: axis.as_slice()?,
            edge: edge.as_ref().map(|edge| edge.as_slice()).transpose()?,
        };
        let near = near.as_slice()?;
        let kinematics = self.loaded.kinematics();
        let Solutions { width, q, counts } = match points > AT_ONCE {
            true => apart(py, |stop| kinematics.inverse(stop, &wanted, near, within_travel)),
            false => at_once(py, |stop| kinematics.inverse(stop, &wanted, near, within_travel)),
        }?;
        let q = shaped(Array3::from_shape_vec((points, width, kinematics.count()), q))?;
        Ok((q.into_pyarray(py), Array1::from(counts).into_pyarray(py)))
    }

    /// The solution over a whole pass.
    fn route<'py>(
        &self,
        py: Python<'py>,
        tip: InputRows<'py>,
        axis: InputRows<'py>,
        edge: Option<InputRows<'py>>,
        cut: PyReadonlyArray1<'py, bool>,
    ) -> PyResult<OutputRows<'py>> {
        let points = tip.shape()[0];
        let wanted = ToolPoses {
            tip: tip.as_slice()?,
            axis: axis.as_slice()?,
            edge: edge.as_ref().map(|edge| edge.as_slice()).transpose()?,
        };
        let cut = cut.as_slice()?;
        let q = apart(py, |stop| self.loaded.route(stop, &wanted, cut))?;
        let count = self.loaded.kinematics().count();
        Ok(shaped(Array2::from_shape_vec((points, count), q))?.into_pyarray(py))
    }

    /// Posts a CL file.
    fn post(
        &self,
        py: Python<'_>,
        input: PathBuf,
        output: Option<PathBuf>,
        options: Vec<(String, options::OptionInput)>,
        keep_blocks: bool,
    ) -> PyResult<Job> {
        let options = options::told(options);
        let output = output.as_deref();
        let made = apart(py, |stop| self.loaded.post(stop, &input, output, &options, keep_blocks))?;
        Ok(Job { made })
    }

    /// Reads an NC program: JSON, and warnings.
    fn read(
        &self,
        py: Python<'_>,
        program: PathBuf,
        csv: Option<PathBuf>,
        cl: Option<PathBuf>,
        options: Vec<(String, options::OptionInput)>,
    ) -> PyResult<(String, Vec<DiagnosticFields>)> {
        let options = options::told(options);
        let targets = ReadTargets { csv: csv.as_deref(), cl: cl.as_deref() };
        apart(py, |stop| self.loaded.read(stop, &program, targets, &options)).map(given)
    }

    /// Holds an NC program against a CL file: JSON, and warnings.
    #[expect(clippy::too_many_arguments, reason = "they are those of Machine.verify")]
    fn verify(
        &self,
        py: Python<'_>,
        program: PathBuf,
        against: PathBuf,
        axis_tolerance: Option<f64>,
        posted: bool,
        planned: bool,
        clearance: bool,
        options: Vec<(String, options::OptionInput)>,
    ) -> PyResult<(String, Vec<DiagnosticFields>)> {
        let options = options::told(options);
        let how = VerifyOptions { axis_tolerance, posted, planned, clearance };
        apart(py, |stop| self.loaded.verify(stop, &program, &against, how, &options)).map(given)
    }

    /// Predicts an NC program: JSON, and warnings.
    fn predict(
        &self,
        py: Python<'_>,
        program: PathBuf,
        against: Option<PathBuf>,
        period: Option<f64>,
        options: Vec<(String, options::OptionInput)>,
    ) -> PyResult<(String, Vec<DiagnosticFields>)> {
        let options = options::told(options);
        let against = against.as_deref();
        apart(py, |stop| self.loaded.predict(stop, &program, against, period, &options)).map(given)
    }

    /// Looks over an NC program: JSON, and warnings.
    fn lint(
        &self,
        py: Python<'_>,
        program: PathBuf,
        ignore: Vec<String>,
        strict: bool,
        options: Vec<(String, options::OptionInput)>,
    ) -> PyResult<(String, Vec<DiagnosticFields>)> {
        let options = options::told(options);
        apart(py, |stop| self.loaded.lint(stop, &program, &ignore, strict, &options)).map(given)
    }

    /// How far the tool strays from the straight line between axis values, at shares of the way.
    fn deviation<'py>(
        &self,
        py: Python<'py>,
        q0: InputRows<'py>,
        q1: InputRows<'py>,
        shares: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<(Bound<'py, PyArray3<f64>>, OutputRows<'py>)> {
        let (moves, places) = (q0.shape()[0], shares.shape()[0]);
        let (from, to, shares) = (q0.as_slice()?, q1.as_slice()?, shares.as_slice()?);
        let Deviations { tip, axis } =
            at_once(py, |_| Ok(self.loaded.kinematics().deviation([from, to], shares)))?;
        let tip = shaped(Array3::from_shape_vec((moves, places, 3), tip))?;
        let axis = shaped(Array2::from_shape_vec((moves, places), axis))?;
        Ok((tip.into_pyarray(py), axis.into_pyarray(py)))
    }
}

/// An array whose numbers are as many as its shape says.
fn shaped<T>(array: Result<T, numpy::ndarray::ShapeError>) -> PyResult<T> {
    array.map_err(|fault| pyo3::exceptions::PyValueError::new_err(fault.to_string()))
}
