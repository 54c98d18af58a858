// inside after all: no depth beyond the far plane, and once more through the set-up
        .macro  nofarther r
        ld.l    R_DEPTH(\r), r7
        subs    r7, r0, r0
        bnc     near\@
        adds    2048, r7, r8
        subs    r8, r0, r0
        bc      near\@
        adds    -2049, r0, r7
        st.l    r7, R_DEPTH(\r)
near\@: nop
        .endm

doubt:  ld.l    P_CLIPPER(r20), r7
        nop
        calli   r7
        nop
        btne    r0, r22, drop
        nofarther r3
        nofarther r4
        nofarther r5
        decided
        .align  8
more:   d.fnop
            nop
        d.fnop
            br      again
        d.fnop
            nop
        fnop                                // never reached: what follows is single
            nop
        fnop
            nop
