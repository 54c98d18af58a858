//! The CPU of a board. Two programs of different priorities share its time.

use pxpl5_sim::{Span, Time};

/// CPU priority of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Priority {
    /// The interrupt program. The foreground program is suspended while the interrupt program spends CPU time.
    Interrupt,
    /// The foreground program, which continues while the interrupt program spends no CPU time.
    Foreground,
}

impl Priority {
    pub(crate) const ALL: [Self; 2] = [Self::Interrupt, Self::Foreground];
}

/// The CPU of a board: the remaining CPU time of each program, and the program that is running.
#[derive(Debug, Default)]
pub(crate) struct Cpu {
    remaining: [Option<Span>; 2],
    running: Option<(Priority, Time)>,
    /// Programs whose present span is a wait for an instant, which is no work.
    is_waiting: [bool; 2],
    busy: Span,
}

impl Cpu {
    pub(crate) fn begin(&mut self, priority: Priority, span: Span, now: Time) {
        self.settle(now);
        self.remaining[priority as usize] = Some(span);
        self.is_waiting[priority as usize] = false;
        self.dispatch(now);
    }

    /// Begins a wait. It ends as work of the same span does, and counts as none.
    pub(crate) fn begin_wait(&mut self, priority: Priority, span: Span, now: Time) {
        self.begin(priority, span, now);
        self.is_waiting[priority as usize] = true;
    }

    /// Subtracts the CPU time up to `now` from the remaining time of the running program. Work that ends exactly at
    /// `now` is finished.
    pub(crate) fn settle(&mut self, now: Time) {
        let Some((priority, since)) = self.running else {
            return;
        };
        // Charge the time since the last change to the running program.
        let elapsed = now - since;
        if !self.is_waiting[priority as usize] {
            self.busy += elapsed;
        }
        let left = self.remaining[priority as usize].map_or(Span::ZERO, |left| left - elapsed);
        self.remaining[priority as usize] = (left > Span::ZERO).then_some(left);
        self.dispatch(now);
    }

    fn dispatch(&mut self, now: Time) {
        let first = Priority::ALL.into_iter().find(|priority| self.remaining[*priority as usize].is_some());
        self.running = first.map(|priority| (priority, now));
    }

    pub(crate) fn is_done(&self, priority: Priority) -> bool {
        self.remaining[priority as usize].is_none()
    }

    /// Returns the time at which the current work ends if no interrupt occurs.
    pub(crate) fn next_end(&self) -> Option<Time> {
        let (priority, since) = self.running?;
        Some(since + self.remaining[priority as usize]?)
    }

    /// Returns the remaining CPU time, at `now`, of the program of priority `priority`. Returns `None` if its work is
    /// finished.
    pub(crate) fn left(&self, priority: Priority, now: Time) -> Option<Span> {
        let left = self.remaining[priority as usize]?;
        match self.running {
            Some((running, since)) if running == priority => Some(Span(left.0.saturating_sub(now.since(since).0))),
            _ => Some(left),
        }
    }

    pub(crate) const fn busy(&self) -> Span {
        self.busy
    }

    /// Returns the CPU time of all programs up to `now`. `now` must not be earlier than the last call of
    /// [`Cpu::settle`].
    pub(crate) fn busy_at(&self, now: Time) -> Span {
        let Some((priority, since)) = self.running.filter(|running| !self.is_waiting[running.0 as usize]) else {
            return self.busy;
        };
        let left = self.remaining[priority as usize].unwrap_or(Span::ZERO);
        self.busy + left.min(Span(now.0.saturating_sub(since.0)))
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
    fn a_wait_counts_as_no_work() {
        let mut cpu = Cpu::default();
        cpu.begin_wait(Priority::Foreground, Span(100), Time(0));
        cpu.begin(Priority::Interrupt, Span(30), Time(40));
        assert_eq!([cpu.busy_at(Time(40)), cpu.busy_at(Time(60))], [Span(0), Span(20)]);
        cpu.settle(Time(70));
        cpu.settle(Time(130));
        assert!(cpu.is_done(Priority::Foreground));
        assert_eq!(cpu.busy(), Span(30));
    }

    #[test]
    fn an_interrupt_at_the_very_end_of_the_foreground_does_not_delay_it() {
        let mut cpu = Cpu::default();
        cpu.begin(Priority::Foreground, Span(100), Time(0));
        cpu.begin(Priority::Interrupt, Span(30), Time(100));
        assert!(cpu.is_done(Priority::Foreground));
    }
}
