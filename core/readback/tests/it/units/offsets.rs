//! Files of offsets.

use post_machine::description::{Machine, Source, load};
use post_readback::Offsets;

fn machine() -> Machine {
    let source = Source {
        name: "ac-trunnion.toml".to_owned(),
        text: std::fs::read_to_string("../../machines/ac-trunnion.toml").unwrap(),
    };
    load(source, &[], &mut |_| Err("nothing is extended".to_owned())).unwrap()
}

#[test]
fn tables_are_read_in_mm_and_radians() {
    let text = "[work.G54]\nX = 10\nC = 90.0\n[work.\"G54.1 P3\"]\nZ = -2.5\n[length]\n1 = 120\n[radius]\n2 = 5.0\n[tool]\n7 = 80\n[reference.1]\nZ = 500\n";
    let machine = machine();
    let offsets = Offsets::parse(text, "o.toml", &machine).unwrap();
    let place = |name: &str| machine.axes.iter().position(|axis| axis.name == name).unwrap();
    assert_eq!(offsets.work[0].name, "G54");
    assert_eq!(offsets.work[0].shift[place("X")], 10.0);
    assert_eq!(offsets.work[0].shift[place("C")], 90f64.to_radians());
    assert_eq!(offsets.work[1].name, "G54.1 P3");
    assert_eq!(offsets.lengths, [(1, 120.0)]);
    assert_eq!((offsets.radii, offsets.tools), (vec![(2, 5.0)], vec![(7, 80.0)]));
    assert_eq!(offsets.references[0].value, 500.0);
}

#[test]
fn what_is_wrong_is_told_with_its_line() {
    let text = "[work.G54]\nX = \"far\"\nB = 1\n[lenght]\n1 = 2\n[length]\none = 3\n";
    let faults = Offsets::parse(text, "o.toml", &machine()).unwrap_err();
    let told: Vec<(u64, &str)> = faults
        .iter()
        .map(|fault| (fault.place.as_ref().unwrap().line, fault.message.as_str()))
        .collect();
    assert_eq!(told.len(), 4, "{told:?}");
    assert!(told.contains(&(7, "one is no number of a register")), "{told:?}");
    assert!(told.contains(&(4, "[lenght] is no table of offsets")), "{told:?}");
    assert!(told.iter().any(|(line, text)| *line == 3 && text.starts_with("B is no axis")));
}
