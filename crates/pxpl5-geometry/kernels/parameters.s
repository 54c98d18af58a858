// Addresses that both triangle kernels share.
//
// Registers on entry: r16 first triangle, r17 number of triangles (at least 1), r18 where command words go,
// r19 table of bins, r20 parameter block, r21 list of triangles left to the clipper, r2 stack.
// On return: r18 behind the last command, r21 behind the last entry of the list.

// A triangle: three corners of 16 bytes, each x, y, z (single) and colour (0x00BBGGRR).
TRIANGLE_BYTES = 48

// A bin: the address of its next free word. An entry is the address of a command.
REGIONS = 20

// A command: enable; three edges; depth compared, depth loaded again; red, green, blue.
COMMAND_BYTES = 120

// Parameter block, singles: rows x, y, z, w of the transform as c0 c1 c2 t, then the rest.
P_ROWS      = 0
P_ORIGIN    = 64          // eye x, y, z, (unused)
P_GUARD     = 80          // guard band x, y; least w; greatest w
P_SCREEN    = 96          // scale x, y; centre x, y (subpixels)
P_TWO_S     = 112         // 2.0
P_ROUND_S   = 116         // 1.5 * 2^23
P_FLIP      = 120         // the word 0x97000000: less a biased integer it turns the order round
// Doubles.
P_TWO       = 128         // 2.0
P_DEPTH     = 136         // far - near in depth units
P_NEAR      = 144         // near in depth units
P_HALF      = 152         // 0.5
P_TWO52     = 160         // 2^52
P_ROUND     = 168         // 1.5 * 2^52
P_SIXTEENTH = 176         // 1 / 16
P_SIXTEEN   = 184         // 16.0
P_BIAS31    = 192         // 2^52 + 2^31, for signed integers
P_EIGHT     = 200         // 8.0
P_TIE_IN    = 208         // -7.5: floor(k / 16) is the integer nearest to (k - 7.5) / 16
P_TIE_OUT   = 216         // -8.5: the same for an edge that does not own its pixels
// Words: instruction heads of the command (enable, edge, depth compare, depth again, red, green, blue).
P_HEADS     = 224
