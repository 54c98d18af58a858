// A picture that is a whole frame of 640 x 480 in regions of 128 x 128: a row of it is a line of the frame.

LAST_ROW = 479
LAST_OF_REGION = 127

// Row of regions of a row of the picture
        .macro  regionrow r
        shr     7, \r, \r
        .endm

// First row of the picture of a row of regions
        .macro  toprow r, to
        shl     7, \r, \to
        .endm

// First and last row of the picture among lines of the frame
        .macro  firstrow r
        .endm
        .macro  lastrow r
        .endm

// Line of the frame that a row is
        .macro  line r
        .endm

// Expressions over the frame's pixels, restated for the rows of the picture
        .macro  restate
        .endm
        .macro  restated at
        .endm

// The same of a quadratic: xx xy yy x y 1 of 64 bits in f16 to f26
        .macro  quadraticrows
        .endm
