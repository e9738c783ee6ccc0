use post_plugin::{Batch, Event};

fn sample() -> (Batch, Vec<u8>) {
    let mut batch = Batch::default();
    for (line, event) in (7..).zip(Event::samples()) {
        batch.push(line, event);
    }
    let mut bytes = Vec::new();
    batch.put_bytes(&mut bytes);
    (batch, bytes)
}

#[test]
fn a_batch_comes_back_from_its_bytes() {
    let (batch, bytes) = sample();
    let mut again = Batch::default();
    // What it held before is gone.
    again.push(1, Event::rapid(&[1.0, 2.0]));
    again.from_bytes(&bytes).unwrap();
    assert_eq!(again.len(), batch.len());
    for index in 0..batch.len() {
        assert_eq!(again.line(index), batch.line(index));
        assert_eq!(again.event(index), batch.event(index));
    }
}

#[test]
fn bytes_that_are_no_batch_are_refused() {
    let (batch, bytes) = sample();
    let mut again = Batch::default();
    for length in 0..bytes.len() {
        assert_eq!(again.from_bytes(&bytes[..length]), None, "{length}");
        assert!(again.is_empty());
    }
    assert_eq!(again.from_bytes(&[&bytes[..], &[0]].concat()), None);
    // Each length, and each place where the numbers and the texts of an event end, is held to what is there.
    let ends = (0..batch.len()).flat_map(|index| [12, 16].map(|at| 32 + 20 * index + at));
    for place in (0..4).map(|length| 8 * length).chain(ends) {
        let mut wrong = bytes.clone();
        wrong[place..place + 4].copy_from_slice(&u32::MAX.to_ne_bytes());
        assert_eq!(again.from_bytes(&wrong), None, "{place}");
    }
}
