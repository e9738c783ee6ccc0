use post_host::internals::judge;
use post_plugin::{Meaning, VocabularyWord};

#[test]
fn a_word_may_mean_two_things_but_not_one_of_them_twice() {
    let off = VocabularyWord::new("G49", Meaning::LengthOff);
    let both = vec![off.clone(), VocabularyWord::new("G49", Meaning::TcpOff)];
    assert_eq!(judge(both.clone()), Ok(both));
    let fault = judge(vec![off.clone(), off]).unwrap_err();
    assert_eq!(fault, "its vocabulary has `G49` mean LENGTH_OFF twice");
}

#[test]
fn what_no_reader_can_look_for_is_refused() {
    for (word, part) in [
        ("", "a letter that is seen"),
        (" G0", "a letter that is seen"),
        ("G0\nG1", "no line can hold"),
        ("G\u{202e}0", "no line can hold"),
    ] {
        let fault = judge(vec![VocabularyWord { word: word.into(), meaning: Meaning::Rapid }]);
        let fault = fault.unwrap_err();
        assert!(fault.contains(part), "{fault}");
    }
    let long = VocabularyWord { word: "G".repeat(201).into(), meaning: Meaning::Rapid };
    assert!(judge(vec![long]).is_err_and(|fault| fault.contains("201 bytes")));
    let many = (0..1001).map(|index| VocabularyWord {
        word: format!("G{index}").into(),
        meaning: Meaning::Nothing,
    });
    assert!(judge(many.collect()).is_err_and(|fault| fault.contains("more than 1000")));
}
