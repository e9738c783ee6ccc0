use post_plugin::{remark, wrapped};

#[test]
fn long_text_is_parted_at_blanks_and_nothing_of_it_is_lost() {
    assert_eq!(wrapped("as  it is", 9), ["as  it is"]);
    assert_eq!(wrapped("one two three", 8), ["one two", "three"]);
    assert_eq!(wrapped("abcdefghij kl", 4), ["abcd", "efgh", "ij", "kl"]);
    let text = "é".repeat(30) + " " + &"x".repeat(31);
    for most in 4..70 {
        let pieces = wrapped(&text, most);
        assert!(pieces.iter().all(|piece| piece.len() <= most), "{most}");
        assert_eq!(pieces.concat().replace(' ', ""), text.replace(' ', ""));
    }
}

#[test]
fn remarks_stay_in_one_pair_of_parentheses() {
    assert_eq!(remark("Fräser (neu) Ø10\t100%"), "(FRAESER [NEU] D10 100 )");
    assert_eq!(remark("漢\r\n"), "(?)");
    assert_eq!(remark(""), "()");
}
