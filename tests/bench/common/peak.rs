//! How much memory a command takes at most.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// Runs a command to its end; the peak of its resident memory, kB, where the system tells it.
pub fn of(command: &mut Command) -> Result<u64, Box<dyn Error>> {
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn()?;
    let process = Path::new("/proc").join(child.id().to_string());
    let program = |link: &Path| fs::read_link(link.join("exe")).ok();
    let ours = program(Path::new("/proc/self"));
    let mut peak = 0;
    loop {
        if let Some(code) = child.try_wait()? {
            return match code.success() {
                true => Ok(peak),
                false => Err(format!("{command:?}: {code}").into()),
            };
        }
        // Until it runs its own program, a process that was just started shows the memory of the one that started it.
        if program(&process) != ours {
            let now = fs::read_to_string(process.join("status")).unwrap_or_default();
            let high = now.lines().find_map(|line| line.strip_prefix("VmHWM:"));
            let high = high.and_then(|text| text.trim().strip_suffix(" kB")?.parse().ok());
            peak = peak.max(high.unwrap_or(0));
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}
