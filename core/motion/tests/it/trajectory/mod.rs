//! Tasks become set-points: the limits hold, the times are those of closed forms and of LinuxCNC.

mod build;
mod corners;
mod drift;
mod jumps;
mod limits;
mod linuxcnc;
mod look_ahead;
mod profile;
mod robust;
