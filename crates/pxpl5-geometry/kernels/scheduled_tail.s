        d.fnop
            adds    COMMAND_BYTES, r18, r18
passed: d.fnop
            adds    LIST_STEP, r16, r16
        d.fnop
            adds    RECORD_STEP, r3, r3
        d.fnop
            adds    RECORD_STEP, r4, r4
        d.fnop
            adds    -1, r31, r31
        d.fnop
            adds    RECORD_STEP, r5, r5
        d.fnop
            btne    r0, r31, triangles
        fnop
            nop
        fnop
            nop
finished: nexteye
        btne    r0, r17, batch
        ld.l    SAVE(r2), r1
        nop
        bri     r1
        nop

// ---- out of the loop: leave dual-instruction mode
        .align  8
slow:   fnop
            nop
        fnop
            st.l    r31, LEFT(r2)
        doubtful r8
        nop
        subs    r8, r0, r0
        bc      doubt                       // 0 > the words
        call    box
        nop
        safe    r7                          // inside the guard band?
        adds    r7, r24, r8
        adds    r7, r26, r9
        subs    r7, r25, r10
        subs    r7, r27, r11
        or      r8, r9, r8
        or      r10, r11, r10
        or      r8, r10, r8
        subs    r8, r0, r0
        bnc     accepted
        ld.l    P_CLIPPER(r20), r7
        nop
        calli   r7
        nop
        btne    r0, r22, drop
        ld.l    BOX(r2), r24
        ld.l    BOX+4(r2), r25
        ld.l    BOX+8(r2), r26
        ld.l    BOX+12(r2), r27
accepted: ld.l  AREA_WORD+4(r2), r22
        nop
        shl     1, r22, r22
        bte     r0, r22, drop                // nothing to draw
        facing  AREA_WORD+4, drop
        call    bins
        nop
        bte     r0, r22, drop               // no region
        restated_after
        adds    COMMAND_BYTES, r18, r18
drop:   ld.l    LEFT(r2), r31
        adds    LIST_STEP, r16, r16
        adds    -1, r31, r31
        adds    RECORD_STEP, r3, r3
        bte     r0, r31, finished
        br      more
        nop

// the box in integers
box:    orh     0x4B40, r0, r7
        ld.l    LOW_XY(r2), r24
        ld.l    LOW_XY+4(r2), r26
        ld.l    HIGH_XY(r2), r25
        ld.l    HIGH_XY+4(r2), r27
        subs    r24, r7, r24
        subs    r26, r7, r26
        adds    8, r7, r7
        subs    r7, r25, r25
        subs    r7, r27, r27
        st.l    r24, BOX(r2)
        st.l    r25, BOX+4(r2)
        st.l    r26, BOX+8(r2)
        st.l    r27, BOX+12(r2)
        bri     r1
        nop

