use nalgebra::Vector3;
use post_machine::description::{Source, load};
use post_machine::kinematics::batch::LANES;
use post_machine::kinematics::{Joints, Pose};
use post_plugin::Format;
use post_posting::accuracy::Placer;
use post_posting::internals::PlacedBatch;

/// Every node of a batch is, field by field, that of the point alone.
#[test]
fn a_batch_is_settled_as_its_points_are() {
    for tcp in ["post", "control"] {
        let text = format!(
            "name = \"trunnion\"\nchain = \"[w C' A' b Y X Z (S) t]\"\n[workpiece]\nmount = [10, -20, 30]\n\
             [tool]\ngauge = [0, 0, 400]\naxis = [0, 0, 1]\n[axis.C]\nrotary = [0, 0, 1]\npoint = [0, 0, 0]\n\
             cyclic = true\n[axis.A]\nrotary = [1, 0, 0]\npoint = [0, 0.012, 50.004]\ntravel = [-120, 30]\n\
             [axis.X]\nlinear = [1, 0, 0]\ntravel = [-300, 300]\n[axis.Y]\nlinear = [0, 1, 0]\ntravel = [-300, 300]\n\
             [axis.Z]\nlinear = [0, 0, 1]\ntravel = [-600, 300]\n[control]\ndialect = \"fanuc\"\ntcp = \"{tcp}\"\n"
        );
        let source = Source { name: "trunnion".to_owned(), text };
        let machine = load(source, &[], &mut |_| Err(String::new())).expect("a machine");
        let format = Format {
            words: vec![3; 5],
            feed: 1,
            inverse_time: None,
            feed_per_revolution: 4,
            extension: "nc".to_owned(),
            ..Format::default()
        };
        let placer =
            Placer::for_machine(&machine, &format, 100.0, &Joints::default()).expect("a placer");
        let solver = placer.solver();
        let points: Vec<(Pose, Joints)> = (0..LANES)
            .map(|lane| {
                let t = lane as f64;
                let axis = Vector3::new(0.2 + 0.003 * t, 0.3 - 0.005 * t, 1.0).normalize();
                // Some of them beyond the travel of X.
                let tip = Vector3::new(5.5 * t, 3.0 - t, 0.3 * t);
                let pose = Pose { tip, axis, edge: Vector3::zeros() };
                let joints =
                    solver.inverse(&pose, &Joints::default(), 1e-9).expect("a solution")[0];
                (pose, joints)
            })
            .collect();
        let mut batch = PlacedBatch::default();
        batch.settle(&placer, points.iter().map(|(pose, joints)| (*pose, joints)));
        let (mut same, mut left) = (0, 0);
        for (lane, (pose, joints)) in points.iter().enumerate() {
            let alone = placer.settled(*pose, 1.0, joints);
            let mut node = Box::default();
            if batch.take(lane, &mut node) {
                let alone = alone.expect("a node");
                assert_eq!(format!("{node:?}"), format!("{alone:?}"));
                same += 1;
            } else {
                assert!(alone.is_err(), "point {lane} was left");
                left += 1;
            }
        }
        assert!(same > 20 && left > 5, "{same} same, {left} left");
    }
}
