//! Tests of the addresses of the i860 programs.

use super::*;
use crate::layout::{BEGIN_CODE, MESSAGE, ORDER_CODE, ORDER_HEAD, SORT_CODE, TOKEN_CODE, WINDOWS, WINDOWS_CODE};
use crate::{begin, bin_handoff, cube_transform, interpolating, ordering, windows};
use pxpl5_geometry::kernel::{KernelList, KernelPicture};

const SURFACES: [KernelSurface; 3] = [KernelSurface::Gouraud, KernelSurface::Precomputed, KernelSurface::Phong];
const BOTH: [bool; 2] = [false, true];
/// Kernels with and without bins and stored bounding boxes, as pairs (bins, boxes). Bins and boxes do not occur
/// together.
const BINS: [(bool, bool); 3] = [(true, false), (false, false), (false, true)];
const PICTURES: [KernelPicture; 3] = [KernelPicture::Frame, KernelPicture::Field, KernelPicture::Grid];

fn kernels() -> impl Iterator<Item = Kernel> {
    let schedules = [Schedule::Straight, Schedule::Compiled, Schedule::Dual];
    let kinds = schedules.into_iter().flat_map(|schedule| SURFACES.map(|surface| (schedule, surface)));
    let pictures = PICTURES.into_iter().flat_map(|picture| BINS.map(|bins| (picture, bins)));
    let pictures = pictures.filter(|(picture, (binned, _))| *binned || *picture != KernelPicture::Grid);
    let pictures: Vec<_> = pictures.flat_map(|(picture, bins)| BOTH.map(|culls| (picture, bins, culls))).collect();
    kinds.flat_map(move |(schedule, surface)| {
        let list = KernelList::Triangles;
        let kernel = move |(picture, (binned, keeps_boxes), culls)| Kernel {
            schedule,
            surface,
            list,
            picture,
            binned,
            culls,
            keeps_boxes,
            both_eyes: false,
        };
        pictures.clone().into_iter().map(kernel)
    })
}

fn end(program: &Program) -> u32 {
    program.base + program.bytes.len() as u32
}

/// Tests that the i860 programs of a board do not overlap in memory, so each address belongs to one program. The
/// assembler must give no warning for any of them.
#[test]
fn no_two_programs_of_a_board_lie_in_the_same_place() {
    for kernel in kernels().filter(Kernel::can_serve_both_eyes) {
        let program = program(Kernel { both_eyes: true, ..kernel }, true);
        assert!(end(&program) <= SORT_CODE, "{kernel:?} for both eyes ends at {:#x}", end(&program));
        assert!(program.warnings.is_empty(), "{kernel:?} for both eyes: {:?}", program.warnings);
    }
    for kernel in kernels() {
        for program in [program(kernel, true), interpolating::program(kernel)] {
            assert!(program.base == CODE && end(&program) <= SORT_CODE, "{kernel:?} ends at {:#x}", end(&program));
            assert!(program.warnings.is_empty(), "{kernel:?}: {:?}", program.warnings);
        }
    }
    let sort = cube_transform::program();
    assert!(sort.base == SORT_CODE && end(&sort) <= BEGIN_CODE, "{:#x}", end(&sort));
    let token = bin_handoff::program();
    assert!(token.base == TOKEN_CODE && end(&token) <= MESSAGE, "{:#x}", end(&token));
    let windows = windows::program();
    assert!(windows.base == WINDOWS_CODE && end(&windows) <= WINDOWS, "{:#x}", end(&windows));
    let order = ordering::program();
    assert!(order.base == ORDER_CODE && end(&order) <= ORDER_HEAD, "{:#x}", end(&order));
    let [begin, of_slats] = BOTH.map(begin::program);
    for program in [&*sort, &*token, &*windows, &*order, &*begin, &*of_slats] {
        assert!(program.warnings.is_empty(), "{:?}", program.warnings);
    }
    for begin in [begin, of_slats] {
        assert!(begin.base == BEGIN_CODE && end(&begin) <= SPHERE_CODE, "{:#x}", end(&begin));
    }
    let spheres = SURFACES.into_iter().flat_map(|surface| PICTURES.map(|picture| (surface, picture)));
    let kernel = |(surface, picture)| BOTH.map(|keeps_boxes| SphereKernel { surface, picture, keeps_boxes });
    for kernel in spheres.flat_map(kernel) {
        let program = sphere_program(kernel, true);
        assert!(program.base == SPHERE_CODE && end(&program) <= PARAMETERS, "{kernel:?}: {:#x}", end(&program));
        assert!(program.warnings.is_empty(), "{kernel:?}: {:?}", program.warnings);
    }
}
