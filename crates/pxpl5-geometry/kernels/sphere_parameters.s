// Parameter block of spheres. What a view decides comes first; `place` fills it in.

S_ROWS      = 0           // singles: rows x, y, z of the transform to the eye as c0 c1 c2 t
S_ORIGIN    = 48          // singles: eye x, y, z
// Doubles.
S_SCALE     = 64          // what a radius grows by
S_STEP      = 72          // eye units per pixel, x and y, at distance 1 under perspective
S_RATE      = 88          // pixels per eye unit
S_CORNER    = 104         // eye x and y of the middle of pixel (0, 0), at distance 1 under perspective
S_NEAR      = 120         // of the distance and 1: less than 0 before the near plane
S_FAR       = 136         // the same: greater than 0 behind the far plane
S_LEAST     = 152         // a distance that is not greater is behind the eye
S_BASE      = 160         // depth is base + reach / distance, base - reach * distance of a parallel projection
S_REACH     = 168
S_LIGHT     = 176         // towards the light in eye coordinates, x y z
S_AMBIENT   = 200
S_DIFFUSE   = 208
S_PARALLEL  = 216         // word: not 0 for a parallel projection
// What the picture decides.
S_LINE      = 220         // the integer 0 or 1: line of the frame that is the field's first
S_HALF_FRAME = 224        // half the width and, downwards, half the height in pixels
S_PER_HALF  = 240         // one over these
S_FIRST     = 256         // the middle of the first pixel in normalised device coordinates
// Numbers.
S_TWO       = 272         // 2
S_HALF      = 280         // 0.5
S_THREE_HALVES = 288      // 1.5
S_ROUND     = 296         // 1.5 * 2^52
S_ONE       = 304         // 1
S_FOUR      = 312         // 4
S_MINUS_FOUR = 320        // -4
S_MOST      = 328         // greatest coordinate
S_SLACK     = 336         // around a bounding box, pixels
S_MOST_PIXEL = 344        // 4096
S_LIMIT     = 352         // 2^31: a plane with a steeper slope is flat
S_TWO52     = 360         // 2^52
S_RANGE     = 368         // far - near in depth units
S_DEPTH_NEAR = 376        // near in depth units
S_ROOM      = 384         // half of that
S_PARALLEL_LEAST = 392    // what S_LEAST is of a parallel projection
S_UNIT      = 400         // unit of the surface's planes
S_HALF_UNIT = 408
S_256       = 416         // 256
S_511       = 424         // 511
S_QUARTER   = 432         // 0.25
S_WORDS     = 440         // the command with zeros for operands, 53 words at most
// What the picture decides where it is no NTSC frame or field: words, as P_LAST_X and the rest.
S_LAST_X    = 652
S_LAST_Y    = 656
S_COLUMNS   = 660
