// Macros that depend on the picture: for rows, lines and regions, for back faces, and for bins.

.if GRID
// A picture of any size in regions of 128 x 128. The last regions are cut off if the size is not a multiple of 128. A
// row of the picture is a line of the frame. The parameter block has the size.

LAST_OF_REGION = 127

        .macro  regionrow r
        shr     7, \r, \r
        .endm

        .macro  toprow r, to
        shl     7, \r, \to
        .endm

        .macro  firstrow r
        .endm
        .macro  lastrow r
        .endm

        .macro  line r
        .endm

        .macro  restate
        .endm
        .macro  restated at
        .endm

        .macro  quadraticrows
        .endm

// Limits r to the value in the register `most`.
        .macro  atmost r, most
        subs    \most, \r, r0
        bnc     am\@
        mov     \most, \r
am\@:
        .endm

        .macro  lastcolumn r
        ld.l    P_LAST_X(r20), r28
        nop
        shr     4, r28, r28
        atmost  \r, r28
        .endm
        .macro  lastline r
        ld.l    P_LAST_Y(r20), r28
        nop
        shr     4, r28, r28
        atmost  \r, r28
        .endm
        .macro  cutoff r
        lastcolumn \r
        .endm

        .macro  atmostx r
        ld.l    P_LAST_X(r20), r12
        nop
        atmost  \r, r12
        .endm
        .macro  atmosty r
        ld.l    P_LAST_Y(r20), r12
        nop
        atmost  \r, r12
        .endm
        .macro  mostx to
        ld.l    P_LAST_X(r20), \to
        .endm
        .macro  mosty to
        ld.l    P_LAST_Y(r20), \to
        .endm

        .macro  regionnumber row, column
        ld.l    P_COLUMNS(r20), r28
        ixfr    \row, f8
        ixfr    r28, f10
        fmlow.dd f8, f10, f12
        fxfr    f12, r28
        adds    r28, \column, r28
        .endm

        .macro  safe to
        ld.l    P_SAFE(r20), \to
        .endm
.else
// Code that frames and fields share: 640 pixels and five regions across, 7680 subpixels down the frame.

// Limits a number to the last pixel of a row, or to the last row.
        .macro  lastcolumn r
        subs    639, \r, r0
        bnc     lc\@
        mov     639, \r
lc\@:
        .endm
        .macro  lastline r
        subs    LAST_ROW, \r, r0
        bnc     ll\@
        mov     LAST_ROW, \r
ll\@:
        .endm

// Limits a number to the last pixel of a column of regions. In these pictures, no column is cut off.
        .macro  cutoff r
        .endm

// Limits a number to the last subpixel of the frame, or loads the last subpixel.
        .macro  atmostx r
        subs    10239, \r, r0
        bnc     ax\@
        mov     10239, \r
ax\@:
        .endm
        .macro  atmosty r
        subs    7679, \r, r0
        bnc     ay\@
        mov     7679, \r
ay\@:
        .endm
        .macro  mostx to
        mov     10239, \to
        .endm
        .macro  mosty to
        mov     7679, \to
        .endm

// r28 = number of a region from its row and its column. May change f8 to f13.
        .macro  regionnumber row, column
        shl     2, \row, r28                // 5 row + column
        adds    r28, \row, r28
        adds    r28, \column, r28
        .endm

// A distance from pixel (0, 0) in subpixels that is inside the guard band. The guard band ends at 65520 and at twice
// the centre minus 65520.
        .macro  safe to
        or      55264, r0, \to
        .endm

.if FIELD
// A picture that is a field of 640 x 240 in regions of 128 x 120. The rows of the picture are every second line of the
// frame, beginning with line P_LINE.

LAST_ROW = 239
LAST_OF_REGION = 119

        .macro  regionrow r
        subs    LAST_OF_REGION, \r, \r
        shr     31, \r, \r
        .endm

        .macro  toprow r, to
        shl     3, \r, r28
        shl     7, \r, \to
        subs    \to, r28, \to
        .endm

        .macro  firstrow r
        ld.l    P_LINE(r20), r28
        subs    \r, r28, \r
        adds    1, \r, \r
        shra    1, \r, \r
        .endm

        .macro  lastrow r
        ld.l    P_LINE(r20), r28
        subs    \r, r28, \r
        shra    1, \r, \r
        .endm

        .macro  line r
        ld.l    P_LINE(r20), r28
        shl     1, \r, \r
        adds    r28, \r, \r
        .endm

// Converts an expression at `at` of the command to the rows of a field. b becomes 2 b. c becomes c + b if the field
// begins with line 1: r5 is then all ones, otherwise 0.
        .macro  restated at
        ld.l    \at+4(r18), r6
        ld.l    \at+8(r18), r7
        and     r5, r6, r8
        adds    r6, r6, r6
        adds    r8, r7, r7
        st.l    r6, \at+4(r18)
        st.l    r7, \at+8(r18)
        .endm

        .macro  restate
        ld.l    P_LINE(r20), r5
        subs    r0, r5, r5
        restated 8
        restated 24
        restated 40
        restated 56
        restated 76
        restated 92
        restated 108
        .endm

// Converts a quadratic expression in the same way. Its coefficients xx xy yy x y 1 of 64 bits are in f16 to f26.
        .macro  quadraticrows
        bte     r0, r5, even
        fiadd.dd f26, f24, f26
        fiadd.dd f22, f18, f22
        fiadd.dd f26, f20, f26
        fiadd.dd f24, f20, f24
        fiadd.dd f24, f20, f24
even:   fiadd.dd f18, f18, f18
        fiadd.dd f20, f20, f20
        fiadd.dd f24, f24, f24
        fiadd.dd f20, f20, f20
        .endm
.else
// A picture that is a complete frame of 640 x 480 in regions of 128 x 128. A row of the picture is a line of the frame.

LAST_ROW = 479
LAST_OF_REGION = 127

// Row of regions that contains a row of the picture.
        .macro  regionrow r
        shr     7, \r, \r
        .endm

// First row of the picture in a row of regions.
        .macro  toprow r, to
        shl     7, \r, \to
        .endm

// First and last row of the picture in a range of lines of the frame.
        .macro  firstrow r
        .endm
        .macro  lastrow r
        .endm

// Line of the frame that a row of the picture shows.
        .macro  line r
        .endm

// Converts expressions of the frame's pixels to the rows of the picture.
        .macro  restate
        .endm
        .macro  restated at
        .endm

// Converts a quadratic expression in the same way. Its coefficients xx xy yy x y 1 of 64 bits are in f16 to f26.
        .macro  quadraticrows
        .endm
.endif
.endif

.if CULLED
// Triangles that face away are not drawn: jumps to `otherwise` if the high word of the area (in the frame or in a
// register) shows that a triangle faces away. Changes r11, r13 and r14.

        .macro  facing_word otherwise
        ld.l    P_CULL(r20), r13
        ld.l    P_CULL+4(r20), r14
        xor     r13, r11, r13
        and     r14, r13, r13
        subs    r13, r0, r0
        bc      \otherwise
        .endm

        .macro  facing at, otherwise
        ld.l    \at(r2), r11
        facing_word \otherwise
        .endm
        .macro  facing_float high, otherwise
        fxfr    \high, r11
        facing_word \otherwise
        .endm
.else
// Triangles are drawn in both orientations.

        .macro  facing at, otherwise
        .endm
        .macro  facing_float high, otherwise
        .endm
.endif

// Puts the command at r18 into the bin of a region. In: r19 table of bins, r22 number of entries so far. Changes r28,
// r29.
        .macro  insert region
        shl     2, \region, r28
        ld.l    r28(r19), r29
        adds    r28, r19, r28
        adds    1, r22, r22
        st.l    r18, 0(r29)
        adds    4, r29, r29
        st.l    r29, 0(r28)
        .endm
