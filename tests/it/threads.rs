//! A thread has the pitch that the CL file asks for at the speed that is printed: S has no decimals.

use std::fs;

use crate::common::{command, run};

/// A tap of 3.5 mm a turn at 63.66 rpm.
const TAP: &str = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,63.66,CLW\nRAPID\nGOTO/0,0,50\n\
                   CYCLE/TAP,DEPTH,40,MMPR,3.5,CLEAR,5\nGOTO/0,0,0\nCYCLE/OFF\nRAPID\nGOTO/0,0,50\nFINI\n";

#[test]
fn a_thread_has_its_pitch_at_the_speed_that_is_printed() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("tap.ncl"), TAP).unwrap();
    for (dialect, feed) in [
        ("fanuc", " F224."),
        ("haas", " F224."),
        ("mazak", " F224."),
        ("linuxcnc", " K3.5"),
        ("heidenhain", "Q239=+3.5"),
        ("siemens", ",3.5,"),
    ] {
        let mut post = command();
        post.current_dir(folder.path())
            .args(["-q", "-m", "vmc", "--dialect", dialect, "--verify"])
            .args(["--tool-length", "80", "-o", "-", "tap.ncl"]);
        let made = run(&mut post, b"");
        assert_eq!(made.code, 0, "{dialect}: {}", made.err);
        assert!(made.out.contains("S64"), "{dialect}: {}", made.out);
        assert!(made.out.contains(feed), "{dialect}: {}", made.out);
        // A feed that is short of the pitch breaks the tap.
        let program = made.out.replace("F224.", "F218.");
        fs::write(folder.path().join("tap.nc"), &program).unwrap();
        let mut verify = command();
        verify
            .current_dir(folder.path())
            .args(["verify", "tap.nc", "-m", "vmc", "--dialect", dialect])
            .args(["--tool-length", "80", "--against", "tap.ncl"]);
        let verified = run(&mut verify, b"");
        let same = program == made.out;
        assert_eq!(verified.code == 0, same, "{dialect}: {}", verified.err);
    }
}
