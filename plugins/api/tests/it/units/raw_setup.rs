use post_plugin::raw::*;
use post_plugin::{Value, *};

#[test]
fn a_setup_comes_back_as_it_went_and_shorter_from_an_earlier_host() {
    let words = [
        AxisWord { name: "X", diameter: true, ..AxisWord::default() },
        AxisWord { name: "Z", depth: true, travel: Some([-5.0, 300.0]), ..AxisWord::default() },
        AxisWord {
            name: "C",
            rotary: true,
            wrapped: true,
            carries_part: true,
            ..AxisWord::default()
        },
    ];
    let tools = [Tool {
        number: 3,
        name: "ball",
        length: Some(120.0),
        diameter: None,
        corner_radius: Some(5.0),
    }];
    let setup = Setup {
        program: "p",
        machine: "m",
        units: Units::Inch,
        tcp: true,
        turns_part: true,
        words: &words,
        options: &[("a", Value::Integer(1))],
        cl_file: "p.cls",
        accuracy: Some(Accuracy { cut: Tolerance { tip: 0.005, axis: 0.05 }, rapid: 0.5 }),
        ahead: Some(Ahead {
            tools: &tools,
            extents: Some([[0.0; 3], [1.0, 2.0, 3.0]]),
            time: Some(60.0),
        }),
    };
    let kinematics = setup.kinematics();
    assert_eq!((kinematics.table, kinematics.head), (1, 0));
    let wanted = format!("{setup:?}");
    with_setup(&setup, |raw| {
        // SAFETY: it was just made.
        let back = unsafe { PostSetup::with(raw, |setup| format!("{setup:?}")) };
        assert_eq!(back, Some(wanted));
        let shorter = PostSetup { size: std::mem::offset_of!(PostSetup, cl_file) as u64, ..*raw };
        // SAFETY: it has no more than it says.
        let back = unsafe {
            PostSetup::with(&shorter, |setup| {
                assert_eq!((setup.program, setup.words.len()), ("p", 3));
                let told = setup.turns_part || setup.has_diameters();
                (setup.cl_file.is_empty(), setup.accuracy, setup.ahead.is_none(), told)
            })
        };
        assert_eq!(back, Some((true, None, true, false)));
    });
}
