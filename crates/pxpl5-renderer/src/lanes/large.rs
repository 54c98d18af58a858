//! Fast execution of sphere and shading commands. Each of these commands draws many pixels, so the time to decode its
//! words is short in comparison.

use super::Lanes;
use super::columns::ContextColumns;
use super::shade::ShadeAll;
use super::sphere::{DrawSphere, PaintGouraudSphere, PaintPhongSphere};
use super::template::next_enables_all;
use crate::array::Executed;
use crate::command::{
    Command, CommandKind, PhongSphereCommand, Shade, ShadeFields, SphereBody, SphereCommand, SphereScratch,
};
use pxpl5_wire::Word;

/// Columns (arrays with one word for each pixel) and bit shifts that a sphere needs in the layout of the array.
struct SpherePlace {
    root: usize,
    temporary: usize,
    short: u8,
    root_bits: u8,
}

impl Lanes {
    /// Executes the sphere or shading command at the start of `words`, and returns its length in words. Returns `None`
    /// if the words do not begin with a sphere or shading command of this layout.
    pub(super) fn large_command(
        &mut self,
        kind: CommandKind,
        words: &[Word],
        columns: ContextColumns,
        executed: &mut Executed,
    ) -> Option<usize> {
        let (command, used) = Command::decode(words, 0, &self.layout).ok()?;
        // Compute Enable only if a later command can read it.
        let keep = !next_enables_all(words.get(used));
        match command {
            Command::Sphere(sphere) => self.sphere(&sphere, columns, keep)?,
            Command::PhongSphere(sphere) => self.phong_sphere(&sphere, columns, keep)?,
            Command::Shade(shade) => self.shade(&shade, columns, keep)?,
            _ => return None,
        }
        let cost = self.templates.cost(kind)?;
        executed.instructions += cost.instructions;
        executed.clocks += cost.clocks;
        Some(used)
    }

    /// Returns the columns (arrays of words) that a sphere needs. Returns `None` if the bit fields of depth and
    /// radicand have different widths.
    ///
    /// The command's program would then leave a mixture of both in the scratch memory.
    fn sphere_place(&self) -> Option<SpherePlace> {
        let scratch = SphereScratch::in_layout(&self.layout).ok()?;
        let root_bits = scratch.root.width;
        let same = scratch.z.width == 2 * root_bits;
        let place = SpherePlace {
            root: self.column(scratch.root)?,
            temporary: self.column(scratch.z)?,
            short: scratch.short(),
            root_bits,
        };
        same.then_some(place)
    }

    fn sphere(&mut self, sphere: &SphereCommand, columns: ContextColumns, keep: bool) -> Option<()> {
        let place = self.sphere_place()?;
        let body = self.sphere_body(sphere.body, &place);
        let components = [0, 1, 2].map(|i| self.controller.localise(&sphere.colour[i]));
        // A later instruction may reuse the last linear coefficients.
        self.controller.hold(sphere.colour[2]);
        // The kernel needs all columns at once.
        let indices = [columns.z, columns.colour, place.root, place.temporary];
        let [z, colour, root, temporary] = self.columns.many_mut(indices)?;
        let factors = sphere.root_factor;
        self.vectors.run(DrawSphere {
            body,
            root_bits: place.root_bits,
            z_shift: self.layout.z_shift(),
            z,
            root,
            temporary,
            paint: PaintGouraudSphere { components, factors, root_bits: place.root_bits, colour },
            enable: keep.then(|| self.enable.emptied(0..128)),
        });
        Some(())
    }

    fn phong_sphere(&mut self, sphere: &PhongSphereCommand, columns: ContextColumns, keep: bool) -> Option<()> {
        let place = self.sphere_place()?;
        let normals = columns.normal?;
        let body = self.sphere_body(sphere.body, &place);
        let components = [0, 1].map(|i| self.controller.localise(&sphere.normal[i]));
        // A later instruction may reuse the last linear coefficients.
        self.controller.hold(sphere.normal[1]);
        let [nx, ny, nz] = normals;
        let indices = [columns.z, columns.colour, place.root, place.temporary, nx, ny, nz];
        let [z, colour, root, temporary, nx, ny, nz] = self.columns.many_mut(indices)?;
        let constant = sphere.colour & 0xff_ffff;
        let normal = [nx, ny, nz];
        self.vectors.run(DrawSphere {
            body,
            root_bits: place.root_bits,
            z_shift: self.layout.z_shift(),
            z,
            root,
            temporary,
            paint: PaintPhongSphere { components, root_bits: place.root_bits, normal, constant, colour },
            enable: keep.then(|| self.enable.emptied(0..128)),
        });
        Some(())
    }

    /// Stores the coefficients of a sphere for reuse by a later instruction, and returns it with the upper left pixel
    /// of the array as origin of coordinates. If square roots in this layout have less than 12 bits, its shifts of
    /// radicand and depth are larger.
    fn sphere_body(&mut self, body: SphereBody, place: &SpherePlace) -> SphereBody {
        self.controller.hold_quadratic(body.silhouette);
        SphereBody {
            silhouette: self.controller.localise_quadratic(),
            root_shift: body.root_shift + 2 * place.short,
            depth: self.controller.localise(&body.depth),
            depth_shift: body.depth_shift + place.short,
        }
    }

    fn shade(&mut self, shade: &Shade, columns: ContextColumns, keep: bool) -> Option<()> {
        let f = ShadeFields::in_layout(&self.layout).ok()?;
        let [nx, ny, nz] = columns.normal?;
        // Columns of the inputs, followed by columns of the results in the order of `ShadeAll::results`.
        let mut indices = [columns.z, nx, ny, nz, columns.colour, 0, 0, 0, 0, 0, 0];
        let temporaries = [f.a, f.b, f.c, f.root, f.diffuse, f.specular];
        for (index, field) in indices[5..].iter_mut().zip(temporaries) {
            *index = self.column(field)?;
        }
        let [z, nx, ny, nz, results @ ..] = self.columns.many_mut(indices)?;
        self.vectors.run(ShadeAll {
            shade: *shade,
            far: u32::MAX >> (32 - self.layout.plan().z.width),
            z,
            normal: [nx, ny, nz],
            results,
            enable: keep.then(|| self.enable.pixels_mut()),
        });
        Some(())
    }
}
