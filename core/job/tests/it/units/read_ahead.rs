//! A CL file that is read ahead gives the pieces that it gives where it is not.

use std::io::{self, Read};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use post_grammar::{ClPiece, GotoRun};
use post_job::files::{ClInput, ClPieces, ReadAhead};
use post_testkit::{Rng, randomised};

/// A file that fails once `left` bytes of it are read.
struct Failing {
    bytes: io::Cursor<Vec<u8>>,
    left: usize,
}

impl Read for Failing {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let most = into.len().min(self.left);
        if most == 0 {
            return Err(io::Error::other("the disk is gone"));
        }
        let count = self.bytes.read(&mut into[..most])?;
        self.left -= count;
        Ok(count)
    }
}

/// Runs of points, other records, lines that cannot be read, and the end with a line end or without.
fn file(rng: &mut Rng) -> Vec<u8> {
    let mut text = String::new();
    for _ in 0..rng.pick(60) {
        for place in 0..rng.pick(400) {
            text += &format!("GOTO/{}.5,-{},7.25\n", place % 10, rng.pick(10));
        }
        text += &rng.text("(RAPID\n|FEDRAT/MMPM,[1-9]00\n|GOTO/1,oops\n|PPRINT/[A-Z]{0,90}\n|\n)");
    }
    text += &rng.text("(FINI\n|FINI|GOTO/1,2)");
    text.into_bytes()
}

fn input(bytes: &[u8], left: usize, is_file: bool) -> ClInput {
    let bytes = io::Cursor::new(bytes.to_vec());
    let length = is_file.then_some(bytes.get_ref().len() as u64);
    let bytes = Box::new(Failing { bytes, left });
    ClInput { name: "part.cls".to_owned(), bytes, length, further: Arc::default() }
}

/// Every piece, as text that tells it apart, with the bytes up to its end.
fn told(mut pieces: ClPieces<'_>) -> String {
    let mut run = GotoRun::default();
    let mut told = String::new();
    loop {
        let piece = pieces.next(&mut run);
        let (is_last, is_run) = match piece {
            ClPiece::Failed(_) | ClPiece::End => (true, false),
            ClPiece::Gotos(_) => (false, true),
            ClPiece::Record(_) | ClPiece::Unreadable(_) => (false, false),
        };
        told += &format!("{piece:?}");
        if is_run {
            told += &format!("{} {:?}", run.line(0), run.point(run.count() - 1));
        }
        told += &format!(" {}\n", pieces.position());
        if is_last {
            return told + &format!("{} {:?}", pieces.ends_within_a_line(), pieces.length);
        }
    }
}

#[test]
fn reading_ahead_changes_nothing() {
    let (rounds, mut rng) = randomised(40, 91);
    let (mut failed, mut ahead_of_it) = (0, 0);
    for _ in rounds {
        let bytes = file(&mut rng);
        let left = if rng.pick(3) == 0 { rng.pick(bytes.len()) } else { usize::MAX };
        let alone = told(ClPieces::new(input(&bytes, left, true), None));
        failed += u32::from(alone.contains("the disk is gone"));
        let (ahead, over) = (ReadAhead::default(), AtomicBool::new(false));
        let pieces = ClPieces::new(input(&bytes, left, true), Some(&ahead));
        let beside = thread::scope(|scope| {
            scope.spawn(|| {
                while !over.load(Ordering::Relaxed) {
                    let _ = ahead.read_some();
                    thread::yield_now();
                }
            });
            let told = told(pieces);
            over.store(true, Ordering::Relaxed);
            told
        });
        assert!(alone == beside, "{}\n{alone}\n{beside}", String::from_utf8_lossy(&bytes));
        // With room for so many batches and nobody who takes them it stops.
        let ahead = ReadAhead::default();
        let pieces = ClPieces::new(input(&bytes, left, true), Some(&ahead));
        let mut batches = 0;
        while ahead.read_some() {
            batches += 1;
        }
        ahead_of_it = ahead_of_it.max(batches);
        assert!((1..=8).contains(&batches), "{batches}");
        assert!(alone == told(pieces));
    }
    assert!(failed > 0 && ahead_of_it > 2, "{failed} failed, {ahead_of_it} batches");
}

/// Of a pipe nothing is read but by whoever takes it.
#[test]
fn a_pipe_is_not_read_ahead() {
    let ahead = ReadAhead::default();
    let pieces = ClPieces::new(input(b"GOTO/1,2,3\n", usize::MAX, false), Some(&ahead));
    assert!(!ahead.read_some());
    assert!(told(pieces).contains("GOTO") || !ahead.read_some());
}
