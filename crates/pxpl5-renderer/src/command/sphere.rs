//! Sphere commands. Silhouettes are exact, and a square root gives the depth.

use super::draw::{evaluate, load, read_linear};
use super::shade::{SHADE_BITS, SHADE_ROOT};
use super::{CommandKind, MissingField, enable, normal};
use crate::isa::{ArrayInstruction, Expression, ExpressionUse, Operand, Test};
use crate::layout::Layout;
use pxpl5_wire::format::{COLOUR_FRACTION_BITS, NORMAL_FRACTION_BITS};
use pxpl5_wire::{Linear, Quadratic};

/// Silhouette and depth of a sphere, which both kinds of sphere commands contain.
///
/// With perspective, the inverse depth at a pixel is `linear + k sqrt(Q)`. Q is a quadratic expression in the pixel's
/// coordinates. Q is zero on the silhouette. The sender scales Q so that the root needs no factor:
///
/// ```text
/// root  = floor(sqrt((silhouette >> root_shift) & (2^24 - 1)))        12 bits
/// depth = (depth - (root << depth_shift)) >> Z_FRACTION_BITS          24 bits, as for a triangle
/// ```
///
/// The *bulge* is the distance between the plane `depth` and the sphere's surface, at the middle of the sphere, in
/// units of the depth expression. The sender must choose `depth_shift` so that `bulge >> depth_shift` is in 2048 ..
/// 4096. The root then has at least 11 significant bits. At the sphere's middle, `silhouette = 2^root_shift (bulge /
/// 2^depth_shift)^2`. The silhouette must stay within 48 bits on the whole region.
///
/// A layout with roots of 10 bits uses the upper bits of the same operands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SphereBody {
    /// Silhouette expression of 48 bits. A pixel is inside the sphere if its value is `>= 0`.
    pub silhouette: Quadratic,
    /// Number of low bits of the silhouette expression that the square root ignores, 0 to 24.
    pub root_shift: u8,
    /// Depth expression of the plane through the silhouette, with [`pxpl5_wire::format::Z_FRACTION_BITS`] fraction
    /// bits.
    pub depth: Linear,
    /// Number of bits by which the square root is shifted left before its subtraction from the depth, 0 to 20.
    pub depth_shift: u8,
}

/// A sphere with interpolated colour.
///
/// It takes more clocks than a triangle for three reasons. A quadratic expression takes 12 words and 48 clocks, and is
/// evaluated twice: for the sign and for the radicand. The root takes 202 bit clocks. And the depth needs three passes
/// instead of two, because it depends on the stored root. Interpolated colour also takes a product and a limit for each
/// component (134 clocks each).
///
/// The assumed cost, "a little dearer than a triangle", would fit a paraboloid, whose depth is the quadratic expression
/// itself. It takes 318 clocks with a quadratic expression for each colour, or 268 with normals. But its depth is exact
/// only at the silhouette and at the middle, so intersecting spheres would meet in wrong places. This is why the model
/// computes the root.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SphereCommand {
    pub body: SphereBody,
    /// Linear expressions for red, green and blue, with [`COLOUR_FRACTION_BITS`] fraction bits. The command adds a
    /// multiple of the square root to each expression.
    pub colour: [Linear; 3],
    /// Factor of the square root for each colour component, -512 to 511: component = limit(linear + ((root >> 4) *
    /// factor >> 8)).
    ///
    /// The sum must be from -512 to 511, because a larger one would wrap around; `limit` then limits it to 0 to 255.
    pub root_factor: [i16; 3],
}

/// A sphere whose pixels are shaded after the last primitive of the region (Phong).
///
/// The z component of the normal is `root >> 2`, which is `r / 4` at the middle of the sphere, where the root is r. The
/// sender uses the same scale for x and y. The normal's length has no effect, because shading normalizes it. With
/// perspective, linear expressions only approximate its x and y.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PhongSphereCommand {
    pub body: SphereBody,
    /// Expressions for x and y of the normal, with [`NORMAL_FRACTION_BITS`] fraction bits.
    pub normal: [Linear; 2],
    /// Colour of the object, 0x00RRGGBB.
    pub colour: u32,
}

/// Number of bits of the square root in the definition of [`SphereBody`]. Layouts with narrower roots use the upper
/// bits of the operands.
const ROOT_BITS: u8 = 12;
/// Number of upper bits of the square root that the command multiplies by a colour factor.
const COLOUR_ROOT_BITS: u8 = 8;
const FACTOR_BITS: u8 = 10;

#[derive(Clone, Copy)]
pub(crate) struct SphereScratch {
    radicand: Operand,
    pub(crate) root: Operand,
    /// New depth. It occupies the bits of the radicand, which is not needed after the square root.
    pub(crate) z: Operand,
    /// Product of the root and a colour factor, with 8 + 10 bits. It also occupies the bits of the radicand.
    product: Operand,
}

impl SphereScratch {
    pub(crate) fn in_layout(layout: &Layout) -> Result<Self, MissingField> {
        const MISSING: MissingField = MissingField("30 bits of scratch");
        let all = layout.plan().scratch.ok_or(MISSING)?;
        let bits = layout.root_bits().ok_or(MISSING)?;
        let z_bits = layout.plan().z.width;
        let radicand_bits = 2 * bits;
        let low = z_bits.max(radicand_bits);
        if low + bits > all.width {
            return Err(MISSING);
        }
        // If the layout has enough scratch, use the bits that the shading program uses for its root.
        let root = if all.width >= SHADE_BITS { SHADE_ROOT } else { low };
        Ok(Self {
            radicand: all.part(0, radicand_bits),
            root: all.part(root, bits),
            z: all.part(0, z_bits),
            product: all.part(0, COLOUR_ROOT_BITS + FACTOR_BITS),
        })
    }

    /// Returns the number of bits by which the square root in this layout is shorter than 12 bits: 0 or 2.
    pub(crate) const fn short(&self) -> u8 {
        ROOT_BITS - self.root.width
    }

    const fn upper_root(&self, bits: u8) -> Operand {
        self.root.part(self.root.width - bits, bits)
    }
}

/// Appends the instructions for silhouette, square root and depth. These instructions disable the pixels outside the
/// sphere, and the pixels where the sphere is not nearer than the stored Z. Then they store the new Z.
fn coverage(body: &SphereBody, layout: &Layout, scratch: &SphereScratch, out: &mut Vec<ArrayInstruction>) {
    let z = layout.plan().z;
    // Test the sign of the silhouette, then evaluate the same expression again as radicand.
    out.extend([
        evaluate(Expression::Quadratic(body.silhouette), ExpressionUse::DisableNegative),
        evaluate(
            Expression::QuadraticAgain,
            ExpressionUse::Load { field: scratch.radicand, shift: body.root_shift.min(24) + 2 * scratch.short() },
        ),
        ArrayInstruction::SquareRoot { destination: scratch.root, radicand: scratch.radicand },
        evaluate(
            Expression::Linear(body.depth),
            ExpressionUse::LoadMinus {
                field: scratch.z,
                shift: layout.z_shift(),
                subtrahend: scratch.root,
                left_shift: body.depth_shift.min(20) + scratch.short(),
            },
        ),
        ArrayInstruction::Compare { test: Test::Less, a: scratch.z, b: z },
        ArrayInstruction::ShiftRight { destination: z, source: scratch.z, by: 0 },
    ]);
}

fn read_coverage(program: &[ArrayInstruction], layout: &Layout) -> Option<SphereBody> {
    let short = SphereScratch::in_layout(layout).ok()?.short();
    // The positions of the expressions are fixed in the program of a sphere.
    let &[
        _,
        ArrayInstruction::Evaluate { expression: Expression::Quadratic(silhouette), .. },
        ArrayInstruction::Evaluate { usage: ExpressionUse::Load { shift, .. }, .. },
        _,
        ArrayInstruction::Evaluate {
            expression: Expression::Linear(depth),
            usage: ExpressionUse::LoadMinus { left_shift, .. },
        },
        ..,
    ] = program
    else {
        return None;
    };
    // In a layout with a short scratch, the root is `short` bits shorter, and the radicand is 2 * `short` bits shorter.
    let root_shift = shift.checked_sub(2 * short)?;
    let depth_shift = left_shift.checked_sub(short)?;
    Some(SphereBody { silhouette, root_shift, depth, depth_shift })
}

impl SphereCommand {
    pub(super) fn program(&self, layout: &Layout) -> Result<Vec<ArrayInstruction>, MissingField> {
        let scratch = SphereScratch::in_layout(layout)?;
        let mut out = vec![enable(CommandKind::Sphere)];
        coverage(&self.body, layout, &scratch, &mut out);
        for (i, (linear, factor)) in (0..).zip(self.colour.into_iter().zip(self.root_factor)) {
            let component = layout.component(i);
            out.extend(shade_component(linear, factor, component, &scratch));
        }
        Ok(out)
    }

    pub(super) fn read(program: &[ArrayInstruction], layout: &Layout) -> Option<Self> {
        let body = read_coverage(program, layout)?;
        let mut colour = [Linear::default(); 3];
        let mut root_factor = [0; 3];
        for (i, part) in program.get(7..16)?.chunks_exact(3).enumerate() {
            let ArrayInstruction::MultiplyConstant { factor, .. } = part[0] else { return None };
            root_factor[i] = i16::try_from(factor).ok()?;
            colour[i] = read_linear(&part[1])?;
        }
        Some(Self { body, colour, root_factor })
    }
}

/// Returns the instructions for `component := limit(linear + (upper root * factor >> 8))`.
///
/// The upper 10 bits of `scratch.product` hold the sum.
fn shade_component(linear: Linear, factor: i16, component: Operand, scratch: &SphereScratch) -> [ArrayInstruction; 3] {
    let sum = scratch.product.part(8, 10).signed();
    [
        ArrayInstruction::MultiplyConstant {
            destination: scratch.product,
            source: scratch.upper_root(COLOUR_ROOT_BITS),
            factor: i32::from(factor << 6 >> 6),
            factor_bits: FACTOR_BITS,
        },
        evaluate(Expression::Linear(linear), ExpressionUse::Add { field: sum, shift: COLOUR_FRACTION_BITS as u8 }),
        ArrayInstruction::Saturate { destination: component, source: sum },
    ]
}

impl PhongSphereCommand {
    pub(super) fn program(&self, layout: &Layout) -> Result<Vec<ArrayInstruction>, MissingField> {
        let scratch = SphereScratch::in_layout(layout)?;
        let mut out = vec![enable(CommandKind::PhongSphere)];
        coverage(&self.body, layout, &scratch, &mut out);
        for (i, component) in (0..).zip(self.normal) {
            out.push(load(component, normal(layout, i)?, NORMAL_FRACTION_BITS as u8));
        }
        out.extend([
            ArrayInstruction::ShiftRight { destination: normal(layout, 2)?, source: scratch.upper_root(10), by: 0 },
            ArrayInstruction::LoadConstant { destination: layout.plan().colour, value: self.colour },
        ]);
        Ok(out)
    }

    pub(super) fn read(program: &[ArrayInstruction], layout: &Layout) -> Option<Self> {
        let body = read_coverage(program, layout)?;
        let normal = [read_linear(program.get(7)?)?, read_linear(program.get(8)?)?];
        let &ArrayInstruction::LoadConstant { value: colour, .. } = program.get(10)? else { return None };
        Some(Self { body, normal, colour })
    }
}
