// Dual-instruction code: the end of the right eye's loop over corners.

        d.fnop
            adds    TRIANGLE_BYTES, r29, r29
        d.fnop
            adds    -1, r30, r30
        d.fnop
            adds    RECORD_STEP, r6, r6
        d.fnop
            btne    r0, r30, rightcorners
        d.fnop
            adds    RECORDS, r2, r3
        d.fnop
            nop
        d.fnop
            br      again
        d.fnop
            nop
        fnop                                // never executed: single instructions follow
            nop
        fnop
            nop
