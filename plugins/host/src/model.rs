//! An opened error model, wherever it is: what it answers is checked.

use std::cell::RefCell;

use post_plugin::{Curve, Deviation, ModelSession, Tolerance};

#[cfg(unix)]
use crate::described::FunctionTable;
#[cfg(unix)]
use crate::isolation::IsolatedModel;
use crate::library_model::LibraryModel;
use crate::{GivenValue, Plugin, PluginFault, PluginKind, Reason, check_options};

/// An error model at work, for one thread.
#[derive(Debug)]
pub struct OpenedModel {
    plugin: String,
    access: ModelAccess,
    /// Why a value since the last fit could not be had.
    fault: RefCell<Option<String>>,
}

/// How an error model is reached.
#[derive(Debug)]
enum ModelAccess {
    /// Through the C contract.
    Library(LibraryModel),
    /// In a process of its own, which is asked through `&self` too.
    #[cfg(unix)]
    Isolated(RefCell<IsolatedModel>),
}

impl Plugin {
    /// Opens this error model for one program and one thread.
    ///
    /// # Errors
    /// If it is no error model, an option does not fit, or it refuses.
    pub fn error_model(
        &self,
        options: &[(String, GivenValue)],
    ) -> Result<OpenedModel, PluginFault> {
        if self.kind() != PluginKind::ErrorModel {
            return Err(self.other_kind(PluginKind::ErrorModel));
        }
        let options = check_options(self.options(), options)
            .map_err(|fault| self.fault(Reason::Option(Box::new(fault))))?;
        let access = match &self.table {
            #[cfg(unix)]
            FunctionTable::Isolated(library) => {
                let model = IsolatedModel::open(library, options);
                ModelAccess::Isolated(RefCell::new(model.map_err(|reason| self.fault(reason))?))
            }
            _ => {
                let model = LibraryModel::open_plugin(self, &options);
                let refused = |message| self.fault(Reason::Refused { message });
                ModelAccess::Library(model.map_err(refused)?)
            }
        };
        Ok(OpenedModel { plugin: self.name.clone(), access, fault: RefCell::new(None) })
    }
}

impl OpenedModel {
    fn say(&self, message: &str) -> String {
        format!("error model `{}`: {message}", self.plugin)
    }

    fn values<const N: usize>(
        &self,
        curve: &Curve,
        ts: [f64; N],
    ) -> Result<[Deviation; N], String> {
        let mut out = [Deviation::default(); N];
        let asked = match &self.access {
            ModelAccess::Library(model) => model.values(curve, &ts, &mut out),
            #[cfg(unix)]
            ModelAccess::Isolated(model) => model.borrow_mut().values(curve, &ts, &mut out),
        };
        asked.map_err(|message| self.say(&message))?;
        if out.iter().all(Deviation::is_finite) {
            Ok(out)
        } else {
            Err(self.say("the deviation of its curve is not a finite number"))
        }
    }

    /// Whether a curve of its answer can be: what the model answers is not believed before this.
    ///
    /// # Errors
    /// A sentence.
    pub fn check(&self, curve: &Curve) -> Result<(), String> {
        let peaks = [curve.tip_peak, curve.axis_peak];
        if !peaks.iter().all(|peak| peak.is_finite() && *peak >= 0.0) {
            return Err(
                self.say(&format!("its peaks are {} and {}", curve.tip_peak, curve.axis_peak))
            );
        }
        let places = [curve.tip_at, curve.axis_at];
        if !places.iter().all(|at| (0.0..=1.0).contains(at)) {
            return Err(self.say(&format!(
                "its peaks stand at {} and {}, outside the move",
                curve.tip_at, curve.axis_at
            )));
        }
        if !curve.terms.iter().all(|term| term.is_finite()) {
            return Err(self.say("a term of its curve is not a finite number"));
        }
        self.values(curve, [0.0, 0.5, 1.0]).map(|_| ())
    }

    /// The model's answer as it comes, which [`ModelSession::fit`] checks.
    ///
    /// # Errors
    /// Its sentence, or why it could not be asked.
    pub fn answer(
        &mut self,
        tolerance: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String> {
        if let Some(fault) = self.fault.take() {
            return Err(fault);
        }
        let answer = match &mut self.access {
            ModelAccess::Library(model) => model.answer(tolerance, deviation),
            #[cfg(unix)]
            ModelAccess::Isolated(model) => model.get_mut().fit(tolerance, deviation),
        };
        answer.map_err(|message| self.say(&message))
    }
}

impl ModelSession for OpenedModel {
    fn fit(
        &mut self,
        tolerance: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String> {
        let curve = self.answer(tolerance, deviation)?;
        self.check(&curve)?;
        Ok(curve)
    }

    fn value(&self, curve: &Curve, t: f64) -> Deviation {
        match self.values(curve, [t]) {
            Ok([deviation]) => deviation,
            Err(fault) => {
                self.fault.replace(Some(fault));
                Deviation::default()
            }
        }
    }

    fn fault(&self) -> Option<String> {
        self.fault.borrow().clone()
    }
}
