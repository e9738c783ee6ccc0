use post_kit::{Bench, P1};
use post_plugin::Event;
#[test]
fn starts() {
    println!("{}", Bench::of(crate::plugin()).tcp().write_job().unwrap());
    let _ = (P1, Event::Start);
}
