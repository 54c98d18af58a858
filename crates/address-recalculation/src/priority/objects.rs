//! The policy `objects`: each object is in the least often drawn display memory in which the object's image stays
//! correct.

use crate::priority::config::PriorityTiming;
use crate::priority::update::Update;
use crate::priority::validity::level;

/// State of the policy `objects`: the memory of each object, and the time until which the object's image is correct.
#[derive(Clone, Debug)]
pub struct Objects {
    frame_s: f64,
    memories: usize,
    /// Index of each object's display memory, and the time at which the object's image becomes wrong. `None` for an
    /// object that was never drawn.
    objects: Vec<Option<(usize, f64)>>,
    moved: u64,
    draws: u64,
}

impl Objects {
    pub fn new(timing: &PriorityTiming, objects: usize) -> Self {
        let memories = timing.memories as usize;
        Self { frame_s: timing.frame_s(), memories, objects: vec![None; objects], moved: 0, draws: 0 }
    }

    /// Returns the index of the memory that holds an object, or `None` before the first frame.
    pub fn memory(&self, object: usize) -> Option<usize> {
        self.objects.get(object).copied().flatten().map(|(memory, _)| memory)
    }

    /// Returns two counts since the start: how often objects have changed their memory, and how often objects were
    /// drawn.
    pub const fn counts(&self) -> [u64; 2] {
        [self.moved, self.draws]
    }

    /// Computes the updates of frame number `frame`, counted from 0. `periods_s` holds the validity period of each
    /// object from now on, in seconds.
    ///
    /// An object changes its memory only in a frame that draws both the old and the new one. Memory k can be drawn in
    /// every 2^k-th frame, but it is not if the images of all its objects stay correct for 2^k more frames.
    pub fn frame(&mut self, frame: u64, periods_s: &[f64]) -> Update {
        let mut together = vec![false; self.memories];
        // Move objects between memories first.
        for (object, period) in periods_s.iter().enumerate().take(self.objects.len()) {
            self.place(object, frame, *period, &mut together);
        }
        let due: Vec<bool> = (0..self.memories).map(|memory| together[memory] || self.is_due(memory, frame)).collect();
        let now = frame as f64 * self.frame_s;
        // Drawing an object renews its validity period.
        for (held, period) in self.objects.iter_mut().zip(periods_s) {
            if let Some((memory, right_until)) = held
                && due[*memory]
            {
                *right_until = now + period;
                self.draws += 1;
            }
        }
        Update { due, together, reassigns_cells: false }
    }

    fn place(&mut self, object: usize, frame: u64, period_s: f64, together: &mut [bool]) {
        let wanted = level(period_s, self.frame_s, self.memories);
        match self.objects[object] {
            None => self.objects[object] = Some((wanted, f64::NEG_INFINITY)),
            Some((memory, right_until)) if memory != wanted => {
                // The slower memory is drawn in a subset of the faster memory's frames.
                let both_drawn = frame.is_multiple_of(1 << memory.max(wanted));
                if both_drawn {
                    self.objects[object] = Some((wanted, right_until));
                    self.moved += 1;
                    together[memory] = true;
                    together[wanted] = true;
                }
            }
            Some(_) => {}
        }
    }

    fn is_due(&self, memory: usize, frame: u64) -> bool {
        let next = (frame + (1 << memory)) as f64 * self.frame_s;
        let mut inside = self.objects.iter().flatten().filter(|(held_by, _)| *held_by == memory);
        frame.is_multiple_of(1 << memory) && inside.any(|(_, right_until)| *right_until < next)
    }
}
