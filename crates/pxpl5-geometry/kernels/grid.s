// A picture of any size in regions of 128 x 128, the last ones cut off where the size is no multiple; a row of it is a line of the frame.
// Its size stands in the parameter block.

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

// At most what the register says
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
