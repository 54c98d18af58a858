//! Choice of the vector unit at run time.
//!
//! The only `unsafe` of this crate: calling a function that is compiled for a vector unit, after asking the processor
//! whether it has it. Measured to pay: a triangle over a whole region takes 2.5 to 4 times as long without
//! (`cargo bench -p pxpl5-renderer`).
#![allow(unsafe_code)]

/// The vector units that a kernel is compiled for. All give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Vectors {
    /// What every processor of the target has.
    Portable,
    /// x86-64 with AVX2.
    Avx2,
    /// x86-64 with AVX-512 (F, BW, DQ and VL).
    Avx512,
}

impl Vectors {
    /// All units that this processor has, the best last.
    #[must_use]
    pub fn available() -> Vec<Self> {
        let all = [Self::Portable, Self::Avx2, Self::Avx512];
        all.into_iter().filter(|vectors| vectors.present()).collect()
    }

    /// The best unit that this processor has.
    #[must_use]
    pub fn best() -> Self {
        let best = if Self::Avx2.present() { Self::Avx2 } else { Self::Portable };
        if Self::Avx512.present() { Self::Avx512 } else { best }
    }

    #[cfg(target_arch = "x86_64")]
    fn present(self) -> bool {
        match self {
            Self::Portable => true,
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("bmi2"),
            Self::Avx512 => {
                Self::Avx2.present()
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512bw")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
            }
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn present(self) -> bool {
        self == Self::Portable
    }
}

/// A vector unit that is known to be present.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Present(Vectors);

impl Present {
    /// `wanted`, or what every processor has where it is absent.
    pub(crate) fn or_portable(wanted: Vectors) -> Self {
        Self(if wanted.present() { wanted } else { Vectors::Portable })
    }

    /// Runs the kernel compiled for this unit.
    #[inline]
    pub(crate) fn run<K: Kernel>(self, kernel: K) -> K::Output {
        #[cfg(target_arch = "x86_64")]
        match self.0 {
            // SAFETY: a `Present` is made only where the processor says that it has these features.
            Vectors::Avx512 => return unsafe { avx512(kernel) },
            // SAFETY: as above.
            Vectors::Avx2 => return unsafe { avx2(kernel) },
            Vectors::Portable => {}
        }
        kernel.run()
    }
}

/// A loop worth vectorising. `run` must be `#[inline(always)]`, or it is compiled without the unit's features.
pub(crate) trait Kernel {
    type Output;
    fn run(self) -> Self::Output;
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi2")]
fn avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi2,avx512f,avx512bw,avx512dq,avx512vl")]
fn avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}
