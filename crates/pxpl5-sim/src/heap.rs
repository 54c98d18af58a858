//! A heap with four children per node. This heap is half as deep as a binary heap, and the children of a node are
//! adjacent in memory.

/// A type with a sort key. The element with the least key leaves the heap first.
pub(crate) trait Keyed: Copy {
    /// Returns the sort key as one number. One subtraction then compares two keys.
    fn key(&self) -> u128;
}

#[derive(Debug)]
pub(crate) struct QuadHeap<T> {
    items: Vec<T>,
}

const CHILDREN: usize = 4;

impl<T> Default for QuadHeap<T> {
    fn default() -> Self {
        Self { items: Vec::new() }
    }
}

impl<T: Keyed> QuadHeap<T> {
    #[inline]
    pub(crate) fn peek(&self) -> Option<&T> {
        self.items.first()
    }

    pub(crate) const fn len(&self) -> usize {
        self.items.len()
    }

    #[inline]
    pub(crate) fn push(&mut self, item: T) {
        let mut place = self.items.len();
        self.items.push(item);
        // Move the parents down until the item fits.
        while place > 0 {
            let parent = (place - 1) / CHILDREN;
            if self.items[parent].key() <= item.key() {
                break;
            }
            self.items[place] = self.items[parent];
            place = parent;
        }
        self.items[place] = item;
    }

    #[inline]
    pub(crate) fn pop(&mut self) -> Option<T> {
        let last = self.items.pop()?;
        let Some(first) = self.items.first().copied() else { return Some(last) };
        // Move the last item down from the root.
        let mut place = 0;
        while let Some((child, item)) = self.least_child(place).filter(|(_, item)| item.key() < last.key()) {
            self.items[place] = item;
            place = child;
        }
        self.items[place] = last;
        Some(first)
    }

    /// Among the children of node `place`, returns the index and the item of the child with the least key.
    #[inline]
    fn least_child(&self, place: usize) -> Option<(usize, T)> {
        let begin = place * CHILDREN + 1;
        let end = self.items.len().min(begin + CHILDREN);
        let children = self.items.get(begin..end)?;
        let mut least = *children.first()?;
        let mut at = begin;
        for (child, item) in (begin..).zip(children) {
            // Selects without branches, because the result of each comparison is unpredictable.
            let is_less = item.key() < least.key();
            least = if is_less { *item } else { least };
            at = if is_less { child } else { at };
        }
        Some((at, least))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::cmp::Reverse;
    use std::collections::BinaryHeap;

    impl Keyed for u64 {
        fn key(&self) -> u128 {
            u128::from(*self)
        }
    }

    proptest! {
        #[test]
        fn the_heap_equals_the_heap_of_the_standard_library(pushes in proptest::collection::vec((0u64..50, 0usize..3), 0..300)) {
            let mut heap = QuadHeap::default();
            let mut expected = BinaryHeap::new();
            for (item, pops) in pushes {
                heap.push(item);
                expected.push(Reverse(item));
                for _ in 0..pops {
                    prop_assert_eq!(heap.peek().copied(), expected.peek().map(|Reverse(item)| *item));
                    prop_assert_eq!(heap.pop(), expected.pop().map(|Reverse(item)| item));
                }
                prop_assert_eq!(heap.len(), expected.len());
            }
        }
    }
}
