// Parameter block of spheres. The first part depends on the view; `place` writes this part.

S_ROWS      = 0           // singles: rows x, y, z of the transform to the eye as c0 c1 c2 t
S_ORIGIN    = 48          // singles: eye x, y, z
// Doubles.
S_SCALE     = 64          // factor by which a radius grows
S_STEP      = 72          // eye units per pixel, x and y, at distance 1 under perspective
S_RATE      = 88          // pixels per eye unit
S_CORNER    = 104         // eye x and y of the middle of pixel (0, 0), at distance 1 under perspective
S_NEAR      = 120         // coefficients of the distance and of 1: the sum is less than 0 before the near plane
S_FAR       = 136         // coefficients of the distance and of 1: the sum is greater than 0 beyond the far plane
S_LEAST     = 152         // a sphere is behind the eye if its distance is not greater
S_BASE      = 160         // depth is base + reach / distance, or base - reach * distance for a parallel projection
S_REACH     = 168
S_LIGHT     = 176         // direction towards the light in eye coordinates, x y z
S_AMBIENT   = 200
S_DIFFUSE   = 208
S_PARALLEL  = 216         // word: not 0 for a parallel projection
// Numbers that depend on the picture.
S_LINE      = 220         // the integer 0 or 1: line of the frame that is the first line of the field
S_HALF_FRAME = 224        // half the width and half the height (downwards) in pixels
S_PER_HALF  = 240         // reciprocals of these
S_FIRST     = 256         // the middle of the first pixel in normalised device coordinates
// Constants.
S_TWO       = 272         // 2
S_HALF      = 280         // 0.5
S_THREE_HALVES = 288      // 1.5
S_ROUND     = 296         // 1.5 * 2^52
S_ONE       = 304         // 1
S_FOUR      = 312         // 4
S_MINUS_FOUR = 320        // -4
S_MOST      = 328         // greatest coordinate
S_SLACK     = 336         // margin around a bounding box, pixels
S_MOST_PIXEL = 344        // 4096
S_LIMIT     = 352         // 2^31: a plane with a steeper slope becomes flat
S_TWO52     = 360         // 2^52
S_RANGE     = 368         // far - near in depth units
S_DEPTH_NEAR = 376        // near in depth units
S_ROOM      = 384         // half of near in depth units
S_PARALLEL_LEAST = 392    // S_LEAST for a parallel projection
S_UNIT      = 400         // unit of the surface's planes
S_HALF_UNIT = 408
S_256       = 416         // 256
S_511       = 424         // 511
S_QUARTER   = 432         // 0.25
S_WORDS     = 440         // the command with operands of zero, 53 words at most
// Words for a picture that is no NTSC frame or field, as P_LAST_X and the words after it.
S_LAST_X    = 652
S_LAST_Y    = 656
S_COLUMNS   = 660
