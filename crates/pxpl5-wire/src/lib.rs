//! What travels on the ring of Pixel-Planes 5: words, messages, addresses, expressions.
