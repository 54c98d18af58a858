//! The rules of the ring word by word: slow, literal, and the measure of the fast ring.
