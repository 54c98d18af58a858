        d.fnop
            adds    TRIANGLE_BYTES, r29, r29
        morecorners
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
            adds    RECORD, r3, r4
        d.fnop
            adds    2*RECORD, r3, r5
triangles:
        passover
        doubtfulpairs
