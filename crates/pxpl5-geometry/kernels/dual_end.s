// Dual-instruction code: triangles in doubt, and the start of the right eye.

// The triangle is inside the guard band after all. Limits a depth to the far plane; the triangle then passes the set-up
// again.
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
        fnop                                // never executed: single instructions follow
            nop
        fnop
            nop

.if BOTH_EYES
// ---- the same batch for the right eye: writes positions and depths of the corners into the records, which keep their
// colours
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
