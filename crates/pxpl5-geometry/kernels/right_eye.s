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
