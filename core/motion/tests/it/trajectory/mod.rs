//! Tasks become set-points: the limits hold, the times are those of closed forms and of LinuxCNC.

mod build;
mod linuxcnc;
