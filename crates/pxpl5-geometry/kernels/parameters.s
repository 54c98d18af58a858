// Addresses that all triangle kernels share.
//
// Registers on entry: r16 first triangle, r17 number of triangles (at least 1), r18 address for command words, r19
// table of bins, r20 parameter block, r2 stack. The frame of a kernel lies above r2, and the frame of the clipper below
// r2. On return: r18 address after the last command.

// A triangle of the display list: three corners of 32 bytes, each position x, y, z (single), colour (0x00RRGGBB),
// normal x, y, z (single), unused.
TRIANGLE_BYTES = 96
COLOUR = 12
NORMAL = 16

// A vertex of a strip has the format of such a corner. Its last word is 0 if it makes a triangle with the two vertices
// before it. For strips, r16 is the first vertex and r17 the number of vertices, at least 3. The code may read two
// vertices after the last one.
VERTEX_BYTES = 32
BEGINS = 28

// A bin: the address of its next free word. An entry is the address of a command.

// Output of the surface routine: component k of corner n is a biased word. The double with this low word and the high
// word of 2^52, minus P_SURFACE, is the value of a plane at the corner.
SURFACE_CORNER = 64
SURFACE_WORD   = 8

// Parameter block, singles: rows x, y, z, w of the transform as c0 c1 c2 t, and further numbers.
P_ROWS      = 0
P_ORIGIN    = 64          // position of the eye: x, y, z
P_ZERO      = 76          // 0.0
P_GUARD     = 80          // guard band x, y; least w; greatest w
P_SCREEN    = 96          // scale x, y; centre x, y (subpixels) and 1.5 * 2^23
P_TWO_S     = 112         // 2.0
P_ROUND_S   = 116         // 1.5 * 2^23
P_FLIP      = 120         // the word 0x97000000: this word minus a biased integer reverses the order
P_LINE      = 124         // the integer 0 or 1: line of the frame that is the first line of the field
// Doubles.
P_TWO       = 128         // 2.0
P_DEPTH     = 136         // far - near in depth units
P_NEAR      = 144         // near in depth units
P_HALF      = 152         // 0.5
P_TWO52     = 160         // 2^52, the bias of depths; the bias of surface words follows
P_SURFACE   = 168         // 2^52, or 2^52 + 2^31 for surface words with signs
P_ROUND     = 176         // 1.5 * 2^52
P_SIXTEENTH = 184         // 1 / 16
P_SIXTEEN   = 192         // 16.0
P_BIAS31    = 200         // 2^52 + 2^31, for signed integers
P_EIGHT     = 208         // 8.0
P_TIE_IN    = 216         // -7.5: floor(k / 16) is the integer nearest to (k - 7.5) / 16
P_TIE_OUT   = 224         // -8.5: the same for an edge that does not own its pixels
// Words: instruction heads of the command (enable, edge, depth compare, depth load, three components, colour).
P_HEADS     = 232
P_THREE_HALVES = 264      // 1.5, double
// Singles: rows x, y, z of normals from the world to the eye, in units of the command's normal. Constants of single.s
// follow each row and the direction towards the light.
P_EYE       = 272
P_BAND      = 284         // the guard band of single.s in subpixels
P_NEAR_S    = 300         // near in depth units
P_THIRTY_SECOND = 316     // 1 / 32
P_FIELD_ROUND = 332       // 1.5 * 2^23 plus the subpixels above the first line of the field
P_LIGHT     = 320         // direction towards the light in the coordinates of the normals
P_AMBIENT   = 336         // fraction of the colour that is visible in shadow
P_DIFFUSE   = 340         // fraction that is added if the light falls at a right angle
P_ONE       = 344         // 1.0
P_TWO23     = 348         // 2^23
P_LEAST_W   = 352         // words: least and greatest w, as in P_GUARD
P_MOST_W    = 356
P_NEARLY    = 360         // 20 << 23, which is added to the bits of w - z to test w <= (w - z) * 2^20: these bits are nearly a logarithm
P_ROUND_LINE = 364        // 1.5 * 2^23, minus 16 in a field that begins with line 1
P_DEPTH_BIAS = 368        // double: 1.5 * 2^52 + near
P_ROUND56   = 376         // double: 1.5 * 2^56
P_TURN      = 384         // single: 3 * 2^23 + 8
// Factors from the surface's words to the planes' values, for both sides (unchanged and reversed): unit (double), unit
// (single, and 4 unused bytes), and half a unit minus 1.5 * 2^23 units (double).
P_SIDES     = 392
P_SIXTEENS  = 440         // doubles: 16, and -16 for reversed triangles
P_DEPTH_SCALE = 456       // single: far - near in depth units
P_SIXTEENTH_S = 460       // single: 1 / 16
P_ROUND52_S = 464         // single: 1.5 * 2^52
P_TWO18     = 468         // single: 2^18, more than any distance in subpixels within the guard band
P_CULL      = 472         // two words: a triangle is not drawn if ((high word of its area ^ first) & second) is negative
P_CLIPPER   = 480         // address of the clipper
P_THIRD     = 488         // double: 1 / 3
// Words with the size of a picture that is no NTSC frame or field.
P_LAST_X    = 496         // last subpixel across and down
P_LAST_Y    = 500
P_COLUMNS   = 504         // number of regions across
P_SAFE      = 508         // distance from pixel (0, 0) in subpixels that is inside the guard band

// Record of a triangle between two views.
E_INSIDE  = 0       // not 0 if all corners are inside the guard band of both views
E_TOP     = 4       // least and greatest y of the corners in both views, 1/16 px of the frame
E_BOTTOM  = 8
E_CORNERS = 16      // for each corner in the first view: x and y, single; depth, double, at:
E_DEPTH   = 8
E_CORNER  = 16
E_VIEW    = 48      // the same for the second view, which follows
E_BYTES   = 112
