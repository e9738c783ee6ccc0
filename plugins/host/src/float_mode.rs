//! What the processor does with numbers: rounding, numbers too small, traps. All that this program computes counts on
//! what it starts with, and a library may leave something else behind (`fesetround`, code built with `-ffast-math`).

#![allow(unsafe_code)]

#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
use std::arch::asm;

/// The control words of the processor's arithmetic, for this thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FloatMode {
    /// MXCSR without its sticky flags: rounding, flush to zero, masks of SSE.
    #[cfg(target_arch = "x86_64")]
    sse: u32,
    /// The control word of the x87: rounding and precision of `long double`.
    #[cfg(target_arch = "x86_64")]
    x87: u16,
    #[cfg(target_arch = "aarch64")]
    fpcr: u64,
}

#[cfg(target_arch = "x86_64")]
impl FloatMode {
    /// The sticky flags of MXCSR: they say what has happened, not what shall.
    const STICKY: u32 = 0x3f;

    /// What is in force.
    #[inline]
    pub(crate) fn now() -> Self {
        let (mut sse, mut x87) = (0_u32, 0_u16);
        // SAFETY: both write the few bytes that their operand has.
        unsafe {
            asm!("stmxcsr [{}]", in(reg) &raw mut sse, options(nostack, preserves_flags));
            asm!("fnstcw [{}]", in(reg) &raw mut x87, options(nostack, preserves_flags));
        }
        Self { sse: sse & !Self::STICKY, x87 }
    }

    /// Puts it in force again.
    #[inline]
    pub(crate) fn restore(self) {
        let now = Self::now();
        if now.sse != self.sse {
            // SAFETY: a value that the register had.
            unsafe {
                asm!("ldmxcsr [{}]", in(reg) &raw const self.sse, options(nostack, preserves_flags));
            }
        }
        if now.x87 != self.x87 {
            // SAFETY: a value that the register had. A trap that waits is cleared first: loading would spring it.
            unsafe {
                asm!("fnclex", "fldcw [{}]", in(reg) &raw const self.x87, options(nostack, preserves_flags));
            }
        }
    }
}

#[cfg(target_arch = "aarch64")]
impl FloatMode {
    /// What is in force.
    #[inline]
    pub(crate) fn now() -> Self {
        let fpcr: u64;
        // SAFETY: reads a register.
        unsafe { asm!("mrs {}, fpcr", out(reg) fpcr, options(nomem, nostack, preserves_flags)) };
        Self { fpcr }
    }

    /// Puts it in force again.
    #[inline]
    pub(crate) fn restore(self) {
        if Self::now() != self {
            // SAFETY: a value that the register had.
            unsafe { asm!("msr fpcr, {}", in(reg) self.fpcr, options(nostack, preserves_flags)) };
        }
    }
}

/// On other processors nothing is known of such a mode.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
impl FloatMode {
    /// What is in force.
    pub(crate) fn now() -> Self {
        Self {}
    }

    /// Puts it in force again.
    pub(crate) fn restore(self) {}
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;
    use std::hint::black_box;

    #[test]
    fn what_was_in_force_is_in_force_again() {
        let usual = FloatMode::now();
        let third = || black_box(1.0) / black_box(3.0_f64);
        let nearest = third();
        let upward = FloatMode { sse: usual.sse | 0x4000, x87: usual.x87 | 0x0800 };
        upward.restore();
        assert_eq!(FloatMode::now(), upward);
        let above = third();
        usual.restore();
        assert!(above > nearest, "it rounded upward");
        assert_eq!((FloatMode::now(), third()), (usual, nearest));
    }
}
