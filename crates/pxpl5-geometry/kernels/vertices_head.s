// Three corners at r29 to the records at r6: relative to the eye, w and its reciprocal by seed and two Newton steps in single precision,
// the other coordinates, snapped and turned round, depth, whether it may lie outside of the depths, and the surface.
//
// A record: x and y, snapped, as singles of 1.5 * 2^23 and more; 8 - x and 8 - y in the same way; depth as a double of
// 1.5 * 2^52 and more; of the first corner alone the place of the triangle's side in the table of sides, and a word that is
// negative where the exact tests must decide; the three words of the surface, as singles of 1.5 * 2^23 and more; the colour.
R_SNAPPED = 0
R_TURNED  = 8
R_DEPTH   = 16
R_SIDE    = 24
R_DOUBT   = 28
R_SURFACE = 32
R_COLOUR  = 44
R_BEGINS  = 48      // in strips alone: not 0 where the vertex makes no triangle with the two before

