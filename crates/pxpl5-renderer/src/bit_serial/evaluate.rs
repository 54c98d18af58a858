//! Execution of instructions that evaluate an expression. The bits of the expression arrive in the pixels one by one,
//! and change Enable or pixel memory.

use super::BitSerial;
use super::delivery::{Delivery, ExpressionEffect};
use super::evaluator::{LinearStreams, QuadraticStreams, VectorPlace, WholeTrees};
use super::tile::{HEIGHT, Tile};
use crate::array::FaultKind;
use crate::controller::LocalExpression;
use crate::isa::{Expression, ExpressionUse, Operand};
use crate::simd::{SimdVector, VectorKernel};
use std::ops::Range;

struct DeliverToTiles<'a, E: WholeTrees> {
    coefficients: &'a E::Coefficients,
    delivery: &'a Delivery,
    tiles: &'a mut [Tile],
    skipping: bool,
}

impl<E: WholeTrees> VectorKernel for DeliverToTiles<'_, E> {
    type Output = ();

    #[inline(always)]
    fn run<V: SimdVector>(self) {
        if !self.tiles.iter().any(|tile| tile.has_work(self.skipping)) {
            return;
        }
        let evaluator = E::run_trees::<V>(self.coefficients, self.delivery.taken.end);
        for (number, tile) in self.tiles.iter_mut().enumerate().filter(|(_, tile)| tile.has_work(self.skipping)) {
            // Each vector lane is one row of the tile.
            for row in (0..HEIGHT).step_by(V::LANES) {
                self.delivery.run_pixels::<V, E>(&evaluator, tile, VectorPlace::in_array(number, row));
            }
        }
    }
}

impl BitSerial {
    /// Executes an instruction that evaluates an expression in all pixels.
    ///
    /// With a linear expression it ends after the last bit that the pixels use, with a quadratic one after all bits.
    pub(super) fn evaluate(&mut self, expression: &Expression, usage: &ExpressionUse) -> Result<(), FaultKind> {
        let delivery = &self.delivery(usage, expression.bits())?;
        let local = self.controller.latch(expression);
        let vectors = self.vectors;
        let skipping = self.skipping;
        let tiles = &mut self.tiles[..];
        // A linear expression can end early. A quadratic expression keeps the trees busy until its last bit.
        match &local {
            LocalExpression::Linear(coefficients) => {
                self.clock += delivery.taken.end as u64;
                vectors.run(DeliverToTiles::<LinearStreams> { coefficients, delivery, tiles, skipping });
            }
            LocalExpression::Quadratic(coefficients) => {
                self.clock += u64::from(local.bits());
                vectors.run(DeliverToTiles::<QuadraticStreams> { coefficients, delivery, tiles, skipping });
            }
        }
        Ok(())
    }

    /// Returns the bits of an expression that an instruction uses, and the operation on these bits. `bits` is the
    /// length of the expression.
    pub(super) fn delivery(&self, usage: &ExpressionUse, bits: u32) -> Result<Delivery, FaultKind> {
        // A test of the sign uses only the last bit. A difference uses all bits, because it needs their borrow.
        let (taken, effect) = match *usage {
            ExpressionUse::DisableNegative => (bits as usize - 1..bits as usize, ExpressionEffect::DisableNegative),
            ExpressionUse::Load { field, shift } => {
                let (taken, first) = self.taken_by(field, shift)?;
                (taken, ExpressionEffect::Load { first })
            }
            ExpressionUse::Add { field, shift } => {
                let (taken, first) = self.taken_by(field, shift)?;
                (taken, ExpressionEffect::Add { first })
            }
            ExpressionUse::DisableNotLess { field, shift } => {
                let (taken, first) = self.taken_by(field, shift)?;
                (taken, ExpressionEffect::DisableNotLess { first })
            }
            ExpressionUse::LoadMinus { field, shift, subtrahend, left_shift } => {
                let (taken, first) = self.taken_by(field, shift)?;
                let subtrahend = self.controller.bits(subtrahend)?;
                let left_shift = left_shift.into();
                (0..taken.end, ExpressionEffect::LoadMinus { first, shift: taken.start, subtrahend, left_shift })
            }
        };
        Ok(Delivery { taken, effect })
    }

    /// Returns the range of the expression's bits that an instruction writes to `field`, and the address of the field's
    /// first bit. The lowest `shift` bits of the expression are not written.
    fn taken_by(&self, field: Operand, shift: u8) -> Result<(Range<usize>, usize), FaultKind> {
        let field = self.controller.bits(field)?;
        let shift = usize::from(shift);
        Ok((shift..shift + field.width, field.first))
    }
}
