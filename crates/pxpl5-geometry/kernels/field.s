// A picture that is a field of 640 x 240 in regions of 128 x 120: its rows are every second line of the frame, from line
// P_LINE on.

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

// An expression at `at` of the command: c + b where the field begins with line 1 (r5 is all ones then, else 0), 2 b
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

// The same of a quadratic: xx xy yy x y 1 of 64 bits in f16 to f26
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
