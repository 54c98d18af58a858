// The corners of a triangle are those of one eye.

        .macro  firstcorner to
        adds    CORNERS, r2, \to
        .endm
        .macro  surfaceof k
        adds    C_SURFACE+8*\k, r0, r10
        .endm
