//! Policy `objects`: every object in the slowest memory in which its image stays right.

use crate::config::PriorityTiming;
use crate::update::Update;
use crate::validity::level;

/// The state of the policy: where each object is, and until when its image is right.
#[derive(Clone, Debug)]
pub struct Objects {
    frame_s: f64,
    memories: usize,
    /// Memory of each object, and the instant at which its image becomes wrong; `None` before it is drawn.
    objects: Vec<Option<(usize, f64)>>,
    moved: u64,
    draws: u64,
}

impl Objects {
    /// The policy for so many objects.
    #[must_use]
    pub fn new(timing: &PriorityTiming, objects: usize) -> Self {
        let memories = timing.memories as usize;
        Self { frame_s: timing.frame_s(), memories, objects: vec![None; objects], moved: 0, draws: 0 }
    }

    /// The memory that an object is in; `None` before the first frame.
    #[must_use]
    pub fn memory(&self, object: usize) -> Option<usize> {
        self.objects.get(object).copied().flatten().map(|(memory, _)| memory)
    }

    /// Objects that changed their memory, and objects that were drawn, since the beginning.
    #[must_use]
    pub const fn counts(&self) -> [u64; 2] {
        [self.moved, self.draws]
    }

    /// Frame number `frame` from 0, with the validity period of each object from now on, s.
    ///
    /// An object changes between two memories only when both are drawn. A memory is drawn in its own frames, unless the images
    /// of all its objects are right until the next of them.
    pub fn frame(&mut self, frame: u64, periods_s: &[f64]) -> Update {
        let mut together = vec![false; self.memories];
        for (object, period) in periods_s.iter().enumerate().take(self.objects.len()) {
            self.place(object, frame, *period, &mut together);
        }
        let due: Vec<bool> = (0..self.memories).map(|memory| together[memory] || self.is_due(memory, frame)).collect();
        let now = frame as f64 * self.frame_s;
        for (held, period) in self.objects.iter_mut().zip(periods_s) {
            if let Some((memory, right_until)) = held
                && due[*memory]
            {
                *right_until = now + period;
                self.draws += 1;
            }
        }
        Update { due, together, deals_anew: false }
    }

    fn place(&mut self, object: usize, frame: u64, period_s: f64, together: &mut [bool]) {
        let wanted = level(period_s, self.frame_s, self.memories);
        match self.objects[object] {
            None => self.objects[object] = Some((wanted, f64::NEG_INFINITY)),
            Some((memory, right_until)) if memory != wanted => {
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
