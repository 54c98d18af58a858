// Dual-instruction code: triangles in doubt, and the start of the right eye.

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

.if BOTH_EYES
// ---- the same batch for the right eye: its corners to the places and depths of the records, whose colours stay
        .pool   r1 r7 r8 r9 r10 r11 r12 r13 r14 r15 r22 r23 r26 r27 r28

righteye: shl   5, r31, r7
        shl     6, r31, r8
        subs    r16, r7, r16
        subs    r16, r8, r16
        turns
        mov     r16, r29
        adds    RECORDS, r2, r6
        .align  8
        d.fnop
            nop
rightcorners:
.endif
