use crate::content::Content;
use crate::drawn::Drawn;
use crate::registration::{Evaluator, Lost, middle};
use crate::reproject::Move;
use crate::rows::Rows;
use crate::shown::{Seen, Shown};
use glam::DVec2;
use pxpl5_run::{FinalResults, Warp};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use tracking::Pose;
use tracking::view::Hmd;

#[derive(Clone, Debug)]
pub(crate) enum Moved {
    /// The pixel shows content of a picture, with the pose for which the picture was drawn.
    Shows(Content, Drawn),
    /// No picture that can be evaluated covers the pixel. For example, the picture at the pixel is incomplete.
    NotComplete(Seen),
    /// The last picture does not have the content.
    Lost(Lost),
}

/// Largest number of iterations in the search for the picture position that a pixel shows. If parts of a picture have
/// different poses, the pose depends on the position and the position on the pose.
const STEPS: usize = 4;

/// Returns the content of a pixel that is lit from the time `at` on, after the picture has been moved to the pose
/// `now`.
pub(crate) fn moved(
    (evaluator, shown, run): (&Evaluator, &Shown, &FinalResults<'_>),
    (by, now): (Warp, &Pose),
    place: [u32; 2],
    field: PeriodNumber,
    at: Time,
) -> Moved {
    let target = middle(place[0], place[1]);
    // The region that contains the source determines the pose, and the pose determines the source. Search for a source
    // that lies in its own region.
    let mut pixel = place;
    let mut last = Moved::Lost(Lost::Beyond);
    for _ in 0..STEPS {
        let drawn = match shown.seen(run, pixel, field, at) {
            Seen::Complete(drawn) => drawn,
            other => return Moved::NotComplete(other),
        };
        let (content, source) = match source(evaluator, by, now, &drawn, target) {
            Ok(found) => found,
            Err(lost) => return Moved::Lost(lost),
        };
        last = Moved::Shows(content, drawn);
        let next = pixel_at(&evaluator.view, source, Rows::lit(run.record.display(), field));
        if next == pixel {
            break;
        }
        pixel = next;
    }
    last
}

/// Returns the content that moves to a screen position, and the position of this content in the picture.
///
/// Returns `None` if no content moves to this position. `reason` then states the reason.
fn source(evaluator: &Evaluator, by: Warp, now: &Pose, drawn: &Drawn, target: DVec2) -> Result<(Content, DVec2), Lost> {
    let moment = evaluator.moment(drawn);
    // Cube faces are several pictures, each with its own depth. For them, a device corrects only the rotation.
    if by == Warp::Depth && !matches!(drawn, Drawn::Faces(_)) {
        return evaluator.warped(&moment, now, target);
    }
    let source = Move::between(by, &evaluator.view, &moment.pose, now).source(&evaluator.view, target);
    let source = source.filter(|source| evaluator.view.contains(*source)).ok_or(Lost::Beyond)?;
    Ok((evaluator.content(drawn, source), source))
}

/// Returns the pixel at the position `place`, in the nearest row that the field lights.
fn pixel_at(view: &Hmd, place: DVec2, rows: Rows) -> [u32; 2] {
    let last = view.centre_px() * 2.0 - DVec2::ONE;
    let inside = place.floor().clamp(DVec2::ZERO, last);
    [inside.x as u32, rows.beside(inside.y as u32)]
}
