//! The processor's time, shared by the programs of two priorities.

use pxpl5_sim::{Span, Time};

/// Which program may interrupt which.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Priority {
    /// Runs at once; the foreground stands still meanwhile.
    Interrupt,
    /// Runs while no interrupt program spends time.
    Foreground,
}

impl Priority {
    pub(crate) const ALL: [Self; 2] = [Self::Interrupt, Self::Foreground];
}

/// Time that the program of each priority still has to spend, and who is running.
#[derive(Debug, Default)]
pub(crate) struct Cpu {
    remaining: [Option<Span>; 2],
    running: Option<(Priority, Time)>,
    busy: Span,
}

impl Cpu {
    /// The program of a priority begins to spend `span`.
    pub(crate) fn begin(&mut self, priority: Priority, span: Span, now: Time) {
        self.settle(now);
        self.remaining[priority as usize] = Some(span);
        self.dispatch(now);
    }

    /// Brings the accounts up to `now`; work that ends exactly now is finished, whoever asks first.
    pub(crate) fn settle(&mut self, now: Time) {
        let Some((priority, since)) = self.running else {
            return;
        };
        let elapsed = now - since;
        self.busy += elapsed;
        let left = self.remaining[priority as usize].map_or(Span::ZERO, |left| left - elapsed);
        self.remaining[priority as usize] = (left > Span::ZERO).then_some(left);
        self.dispatch(now);
    }

    fn dispatch(&mut self, now: Time) {
        let first = Priority::ALL.into_iter().find(|priority| self.remaining[*priority as usize].is_some());
        self.running = first.map(|priority| (priority, now));
    }

    /// Whether the program of a priority has spent all it asked for.
    pub(crate) fn is_done(&self, priority: Priority) -> bool {
        self.remaining[priority as usize].is_none()
    }

    /// When the running work ends, if nothing interrupts it.
    pub(crate) fn next_end(&self) -> Option<Time> {
        let (priority, since) = self.running?;
        Some(since + self.remaining[priority as usize]?)
    }

    /// What is left at an instant of the work of a priority; `None` where it has none.
    pub(crate) fn left(&self, priority: Priority, now: Time) -> Option<Span> {
        let left = self.remaining[priority as usize]?;
        match self.running {
            Some((running, since)) if running == priority => Some(Span(left.0.saturating_sub(now.since(since).0))),
            _ => Some(left),
        }
    }

    /// Time spent so far.
    pub(crate) const fn busy(&self) -> Span {
        self.busy
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interrupt_delays_the_foreground_by_exactly_its_own_time() {
        let mut cpu = Cpu::default();
        cpu.begin(Priority::Foreground, Span(100), Time(0));
        cpu.begin(Priority::Interrupt, Span(30), Time(40));
        assert_eq!(cpu.next_end(), Some(Time(70)));
        cpu.settle(Time(70));
        assert!(cpu.is_done(Priority::Interrupt) && !cpu.is_done(Priority::Foreground));
        assert_eq!(cpu.next_end(), Some(Time(130)));
        cpu.settle(Time(129));
        assert!(!cpu.is_done(Priority::Foreground));
        cpu.settle(Time(130));
        assert!(cpu.is_done(Priority::Foreground));
        assert_eq!(cpu.busy(), Span(130));
    }

    #[test]
    fn an_interrupt_at_the_very_end_of_the_foreground_does_not_delay_it() {
        let mut cpu = Cpu::default();
        cpu.begin(Priority::Foreground, Span(100), Time(0));
        cpu.begin(Priority::Interrupt, Span(30), Time(100));
        assert!(cpu.is_done(Priority::Foreground));
    }
}
