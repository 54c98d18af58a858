        d.fnop
            adds    TRIANGLE_BYTES, r29, r29
        d.fnop
            adds    -1, r30, r30
        d.fnop
            adds    CORNERS_BYTES, r6, r6
        d.fnop
            btne    r0, r30, corners
        d.fnop
            adds    RECORDS, r2, r3
        d.fnop
            subs    r17, r31, r17
        d.fnop
            br      again
        d.fnop
            nop
        .align  32
again:  d.fnop
            ld.l    P_HEADS(r20), r24
        d.fnop
            ld.l    P_HEADS+4(r20), r25
        d.fnop
            adds    48, r3, r4
        d.fnop
            adds    96, r3, r5
triangles:
