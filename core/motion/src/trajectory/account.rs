//! How long each task took, and what for.

use std::collections::VecDeque;

use super::{TaskTime, TimeLimit};

/// Reasons that are kept apart for one task.
const MOST: usize = 8;

/// A task that takes longer than was asked by no more than this share of its time keeps its feed: what its ends cost is
/// not what makes it last.
const KEPT: f64 = 0.02;

/// Times below this are rounding, s.
const NOTHING: f64 = 1e-9;

/// A task that is not yet done.
#[derive(Debug)]
struct OpenTask {
    task: u64,
    line: u64,
    begins: f64,
    /// Time at the programmed feed, s; none for rapids and waits.
    asked: Option<f64>,
    /// Whether the task takes no time.
    empty: bool,
    /// Time beyond what was asked, by reason, s.
    spent: [(TimeLimit, f64); MOST],
}

/// Tasks in order.
#[derive(Debug, Default)]
pub(super) struct TaskAccounts {
    open: VecDeque<OpenTask>,
    done: VecDeque<TaskTime>,
}

impl TaskAccounts {
    pub fn open(&mut self, task: u64, line: u64, asked: Option<f64>, empty: bool) {
        self.open.push_back(OpenTask {
            task,
            line,
            begins: 0.0,
            asked,
            empty,
            spent: [(TimeLimit::Feed, 0.0); MOST],
        });
    }

    /// Adds to what a task has spent: `seconds` on a share of it.
    pub fn spend(&mut self, task: u64, seconds: f64, share: f64, limit: TimeLimit) {
        let first = self.open.front().map(|open| open.task);
        let place = first.and_then(|first| task.checked_sub(first));
        let Some(open) = place.and_then(|place| self.open.get_mut(place as usize)) else {
            return;
        };
        let beyond = seconds - share * open.asked.unwrap_or(0.0);
        let spent = &mut open.spent;
        let place = spent
            .iter()
            .position(|(by, seconds)| *by == limit || *seconds == 0.0)
            .unwrap_or(MOST - 1);
        spent[place].0 = limit;
        spent[place].1 += beyond;
    }

    /// The first task that is open ends at `time`, and the next one begins. It ends when it begins where it is over
    /// before the middle of the time in which the one before overlaps it.
    pub fn border(&mut self, time: f64) {
        let time = self.open.front().map_or(time, |open| time.max(open.begins));
        self.close(time);
        while self.open.front().is_some_and(|open| open.empty) {
            self.close(time);
        }
        if let Some(next) = self.open.front_mut() {
            next.begins = time;
        }
    }

    /// Tasks without time in front of all others begin and end at `time`.
    pub fn skip(&mut self, time: f64) {
        while self.open.front().is_some_and(|open| open.empty) {
            self.close(time);
        }
        if let Some(next) = self.open.front_mut() {
            next.begins = time;
        }
    }

    fn close(&mut self, time: f64) {
        let Some(open) = self.open.pop_front() else {
            return;
        };
        let begins = if open.empty { time } else { open.begins };
        let seconds = time - begins;
        let asked = open.asked.unwrap_or(seconds);
        let kept = open.asked.is_some() && seconds - asked <= NOTHING + KEPT * seconds;
        let none = (TimeLimit::Feed, NOTHING);
        let spent = open.spent.iter().copied().filter(|_| !kept);
        let most = spent.fold(none, |most, spent| match spent.1 > most.1 {
            true => spent,
            false => most,
        });
        self.done.push_back(TaskTime {
            task: open.task,
            line: open.line,
            begins,
            seconds,
            asked,
            limit: most.0,
        });
    }

    /// Hands over the tasks that are done by `time`.
    pub fn done(&mut self, time: f64, times: &mut Vec<TaskTime>) {
        while let Some(done) = self.done.front() {
            if done.begins + done.seconds > time {
                break;
            }
            times.extend(self.done.pop_front());
        }
    }
}
