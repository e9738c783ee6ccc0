//! A dialect or an error model at work in a process of its own.

use std::sync::Arc;

use post_plugin::raw::PostFormat;
use post_plugin::{Batch, Curve, Deviation, Meaning, Tolerance, VocabularyWord, WriteFault};

use super::library::IsolatedLibrary;
use super::message::{Deviations, DialectOpened, Fitted, Request, Written};
use super::process::Process;
use super::wire::Wire;
use crate::function::Function;
use crate::shown::sentence;
use crate::{GivenValue, ProgramSetup, Reason};

/// Most places of a move that a model may ask for, at once or one by one.
const MOST_PLACES: usize = 1 << 20;

/// A process that serves one program.
#[derive(Debug)]
struct Session {
    library: Arc<IsolatedLibrary>,
    /// None once the program has ended.
    process: Option<Process>,
}

impl Session {
    fn new(library: &Arc<IsolatedLibrary>) -> Result<Self, Reason> {
        Ok(Self { library: Arc::clone(library), process: Some(library.process()?) })
    }

    fn process(&mut self) -> Result<&mut Process, String> {
        self.process.as_mut().ok_or_else(|| "its program has ended".to_owned())
    }

    /// What it answers; or the sentence of its death.
    fn ask<R: Wire>(&mut self, request: &Request) -> Result<R, String> {
        self.process()?.ask(request)
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        if let Some(process) = self.process.take() {
            self.library.close(process);
        }
    }
}

fn nonsense(message: String) -> Reason {
    Reason::Nonsense { message }
}

/// A dialect that writes a program.
#[derive(Debug)]
pub(crate) struct IsolatedDialect {
    session: Session,
}

impl IsolatedDialect {
    /// Opens it for a program whose options are complete; its format is to be judged yet.
    pub(crate) fn open(
        library: &Arc<IsolatedLibrary>,
        setup: ProgramSetup,
    ) -> Result<(Self, PostFormat), Reason> {
        let mut session = Session::new(library)?;
        let process = session.process().map_err(nonsense)?;
        let opened: DialectOpened =
            process.ask(&Request::Dialect(Box::new(setup))).map_err(nonsense)?;
        let format = opened.map_err(|message| Reason::Refused { message: sentence(&message) })?;
        let format = format.map_err(|message| nonsense(sentence(&message)))?;
        Ok((Self { session }, format))
    }

    /// As [`post_plugin::LinkedDialect::write`]; what its text holds is to be judged yet.
    pub(crate) fn write(
        &mut self,
        batch: &Batch,
        out: &mut String,
        ends: &mut Vec<usize>,
    ) -> Result<(), WriteFault> {
        let count = batch.len();
        let fault = |index, message| WriteFault { index, message };
        let process = self.session.process().map_err(|message| fault(0, message))?;
        process.forget_progress(count);
        let written: Result<Written, String> =
            process.ask_with(&Request::Write, |to| batch.put_bytes(to));
        let written = match written {
            Ok(written) => written,
            Err(message) => {
                let told = process.told(count).min(count - 1);
                return Err(fault(told, message));
            }
        };
        let base = out.len();
        let mut from = 0;
        for (index, &end) in written.ends.iter().enumerate() {
            let to = usize::try_from(end).ok();
            let piece = to.and_then(|to| Some((to, written.text.get(from..to)?)));
            let Some((to, piece)) = piece.filter(|_| index < count) else {
                return Err(fault(index.min(count - 1), NOT_WHERE.to_owned()));
            };
            out.push_str(piece);
            from = to;
            ends.push(base + from);
        }
        match written.fault {
            Some((_, message)) => Err(fault(written.ends.len().min(count - 1), message)),
            None if written.ends.len() < count || from < written.text.len() => {
                Err(fault(written.ends.len().min(count - 1), NOT_WHERE.to_owned()))
            }
            None => Ok(()),
        }
    }

    pub(crate) fn vocabulary(&mut self) -> Result<Vec<VocabularyWord>, String> {
        let told: Result<Vec<(String, u32)>, String> = self.session.ask(&Request::Vocabulary)?;
        let words = told?.into_iter().map(|(word, meaning)| match Meaning::from_number(meaning) {
            Some(meaning) => Ok(VocabularyWord { word: word.into(), meaning }),
            None => Err(format!("its vocabulary has a meaning that is not known, {meaning}")),
        });
        words.collect()
    }

    pub(crate) fn relies_on(&mut self) -> Result<Vec<String>, String> {
        self.session.ask::<Result<_, String>>(&Request::ReliesOn)?
    }
}

/// Of a text that is not that of its events.
const NOT_WHERE: &str = "the end of its text is not where it says";

/// An error model at work.
#[derive(Debug)]
pub(crate) struct IsolatedModel {
    session: Session,
}

impl IsolatedModel {
    /// Opens it; the options are complete.
    pub(crate) fn open(
        library: &Arc<IsolatedLibrary>,
        options: Vec<(String, GivenValue)>,
    ) -> Result<Self, Reason> {
        let mut session = Session::new(library)?;
        let process = session.process().map_err(nonsense)?;
        let opened: Result<(), String> = process.ask(&Request::Model(options)).map_err(nonsense)?;
        opened.map_err(|message| Reason::Refused { message: sentence(&message) })?;
        Ok(Self { session })
    }

    /// Its answer for a move.
    ///
    /// # Errors
    /// Its sentence, or why there is no answer.
    pub(crate) fn fit(
        &mut self,
        tolerance: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String> {
        self.fit_within(tolerance, deviation)?.map_err(|message| sentence(&message))
    }

    fn fit_within(
        &mut self,
        tolerance: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Result<Curve, String>, String> {
        let mut left = self.session.library.limits().call;
        let process = self.session.process()?;
        process.send(Function::Fit, |to| Request::Fit(*tolerance).put(to))?;
        let mut asked = 0;
        loop {
            match process.answer(Function::Fit, &mut left)? {
                Fitted::Answers(answer) => return Ok(answer.map(|curve| *curve)),
                Fitted::Wants(places) => {
                    // One that asks for nothing asks all the same.
                    asked += places.len().max(1);
                    if asked > MOST_PLACES {
                        let message =
                            format!("it asks for more than {MOST_PLACES} deviations of one move");
                        return Err(process.stop(message));
                    }
                    let mut found: Deviations = vec![Deviation::default(); places.len()];
                    deviation(&places, &mut found);
                    process.send(Function::Fit, |to| found.put(to))?;
                }
            }
        }
    }

    /// Deviations of a fitted curve.
    pub(crate) fn values(
        &mut self,
        curve: &Curve,
        places: &[f64],
        out: &mut [Deviation],
    ) -> Result<(), String> {
        let request = Request::Value(Box::new(*curve), places.to_vec());
        let values: Result<Deviations, String> = self.session.ask(&request)?;
        let values = values.map_err(|message| sentence(&message))?;
        if values.len() != out.len() {
            return Err("it has another number of deviations than places".to_owned());
        }
        out.copy_from_slice(&values);
        Ok(())
    }
}
