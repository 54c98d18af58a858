// What frames and fields share: 640 pixels and five regions across, 7680 subpixels down the frame.

// At most the last pixel, the last row
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

// The same of the last pixel of a column of regions, which is never cut off here
        .macro  cutoff r
        .endm

// At most the last subpixel of the frame, and that itself
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

// r28 = the number of a region by its row and its column; f8 to f13 may change
        .macro  regionnumber row, column
        shl     2, \row, r28                // 5 row + column
        adds    r28, \row, r28
        adds    r28, \column, r28
        .endm

// A distance from pixel (0, 0) in subpixels that is inside the guard band, which ends at 65520 and twice the centre less that
        .macro  safe to
        or      55264, r0, \to
        .endm
