//! The stream behind the stages: what observers see is what the dialect is asked for, and tells the same as the report.

use post_plugin::Capabilities;
use post_posting::program::Command;
use post_posting::{BlockKind, BlockReason, MotionBlock, Observer, StreamItem};
use post_testruns::posted::{Recorder, watched};

use super::*;

/// Keeps all that it sees.
#[derive(Default)]
struct Seen(Vec<StreamItem<MotionBlock>>);

impl Observer for Seen {
    fn blocks(&mut self, blocks: &[StreamItem<MotionBlock>]) {
        self.0.extend_from_slice(blocks);
    }
}

impl Seen {
    fn written(&self) -> Vec<&MotionBlock> {
        let blocks = self.0.iter().filter_map(|next| match next {
            StreamItem::Point(block) if !block.still => Some(block),
            _ => None,
        });
        blocks.collect()
    }
}

/// A job with a tool of so many mm.
fn job(length: f64) -> PostingRequest {
    PostingRequest { tool_length: Some(length), ..PostingRequest::default() }
}

#[test]
fn observers_see_the_blocks_that_the_dialect_is_asked_for() {
    for kind in ["trunnion", "head", "nutating"] {
        for tcp in [false, true] {
            let model = model(kind, tcp, WIDE, &[]);
            let points = walk(&mut seeded(61), 300, 1.5);
            let text = cl(&points, 800.0);
            let (mut first, mut second) = (Seen::default(), Seen::default());
            let run = watched(
                &model.machine,
                Recorder::new(&model.machine, 3),
                &text,
                job(model.length),
                &mut Samples,
                &mut [&mut first, &mut second],
            )
            .good(kind);
            let [seen, also] = [&first.0, &second.0].map(|seen| format!("{seen:?}"));
            assert_eq!(seen, also, "every observer sees the same");
            let (written, motions) = (first.written(), run.motions());
            assert_eq!(written.len(), motions.len());
            for (block, asked) in written.iter().zip(&motions) {
                assert_eq!(block.words[..asked.words.len()], asked.words[..]);
                assert_eq!((block.line, block.time.feed), (asked.line, asked.feed));
                let tool = asked.tool.expect("a motion that says where the tool stands");
                assert_eq!(tool.tip, <[f64; 3]>::from(block.tip));
                // By isometries: the printed words bring the tool there.
                let (tip, axis) = model.reference.forward(&model.positions(&asked.words));
                assert!((tip - block.tip).norm() < 1e-6, "{tip} {}", block.tip);
                assert!(angle(axis, block.axis) < 1e-9);
            }
            let report = run.report.expect("a good run");
            let sum = |cuts: bool| -> f64 {
                let kind = |block: &&&MotionBlock| (block.kind == BlockKind::Linear) == cuts;
                let blocks = written.iter().filter(kind);
                blocks.map(|block| block.time.minutes * 60.0).sum()
            };
            assert!((sum(true) - report.cutting_time_s).abs() < 1e-9 * report.time_s);
            assert!((sum(true) + sum(false) - report.time_s).abs() < 1e-9 * report.time_s);
            let worst = written.iter().filter(|block| !block.loose);
            let worst = worst.fold(0.0, |most: f64, block| most.max(block.deviation.tip));
            assert_eq!(worst, report.tip_deviation_mm.value);
            let put_in = written.iter().filter(|block| block.reason == BlockReason::PutIn);
            assert_eq!(put_in.count() as u64, report.points_added);
            let limited = written.iter().filter(|block| block.time.limit.is_some());
            assert_eq!(limited.count() as u64, report.blocks_limited);
        }
    }
}

#[test]
fn commands_stand_where_they_stood() {
    let model = model("trunnion", false, WIDE, &[]);
    let text = "UNITS/MM\nFEDRAT/500\nLOADTL/1\nSPINDL/1000\nGOTO/0,0,10\nDELAY/1\nGOTO/5,0,10\nCOOLNT/FLOOD\n\
                GOTO/5,5,10\nDELAY/2\nDELAY/3\nGOTO/0,5,10\nFINI\n";
    let mut seen = Seen::default();
    let recorder = Recorder::new(&model.machine, 3);
    let job = job(model.length);
    watched(&model.machine, recorder, text, job, &mut Samples, &mut [&mut seen]).good("a job");
    let lines: Vec<(u64, bool)> = seen
        .0
        .iter()
        .filter_map(|next| match next {
            StreamItem::Point(block) => Some((block.line, true)),
            StreamItem::Command { line, .. } => Some((*line, false)),
            _ => None,
        })
        .collect();
    let lines: Vec<(u64, bool)> = lines.into_iter().filter(|(line, _)| *line > 4).collect();
    let expected = [
        (5, true),
        (6, false),
        (7, true),
        (8, false),
        (9, true),
        (10, false),
        (11, false),
        (12, true),
    ];
    assert_eq!(lines, expected);
}

/// The beginning and the end of an operation are events to a dialect that declares them; to others the name is a
/// remark, as before.
#[test]
fn operations_are_told_to_dialects_that_know_them() {
    let model = model("trunnion", false, WIDE, &[]);
    let text = "TOOL PATH/ROUGH,TOOL,MILL\nUNITS/MM\nLOAD/TOOL,1\nFEDRAT/MMPM,500\nGOTO/0,0,10\nGOTO/5,0,10\n\
                END-OF-PATH\n";
    let kinds = |capabilities: Capabilities| {
        let mut recorder = Recorder::new(&model.machine, 3);
        recorder.capabilities = capabilities;
        let mut seen = Seen::default();
        let run = watched(
            &model.machine,
            recorder,
            text,
            job(model.length),
            &mut Samples,
            &mut [&mut seen],
        )
        .good("a job");
        let named = |next: &StreamItem<MotionBlock>| matches!(next, StreamItem::Command { command: Command::Operation(name), .. } if name == "ROUGH");
        assert!(seen.0.iter().any(named));
        let kinds = run.asked.iter().map(|asked| asked.kind);
        kinds.collect::<Vec<_>>()
    };
    let plain = kinds(Capabilities::NONE);
    assert!(plain.contains(&"Comment") && !plain.contains(&"Operation"));
    let known = kinds(Capabilities::OPERATION);
    let place = |kind| known.iter().position(|known| *known == kind);
    assert!(place("Operation") < place("ToolChange"));
    assert!(place("Linear") < place("OperationEnd") && place("OperationEnd") < place("End"));
    assert!(!known.contains(&"Comment"));
}
