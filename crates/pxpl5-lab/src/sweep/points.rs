/// A set of points of a sweep, with one bit for each point. Ten million points take 1.25 MB.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Points(Vec<u64>);

impl Points {
    pub(super) fn put(&mut self, point: u64) {
        let word = (point / 64) as usize;
        if self.0.len() <= word {
            self.0.resize(word + 1, 0);
        }
        self.0[word] |= 1 << (point % 64);
    }

    pub(super) fn holds(&self, point: u64) -> bool {
        self.0.get((point / 64) as usize).is_some_and(|word| word >> (point % 64) & 1 == 1)
    }
}

impl FromIterator<u64> for Points {
    fn from_iter<I: IntoIterator<Item = u64>>(numbers: I) -> Self {
        let mut points = Self::default();
        numbers.into_iter().for_each(|point| points.put(point));
        points
    }
}
