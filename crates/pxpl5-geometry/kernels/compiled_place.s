// ---- corner: vertex at r5 to the structure at r6, without a normal, and r6 to the next; r7 is 0 if it is outside of the guard band

corner: projected
        guarded
        placed
        fsub.dd f12, f10, f12
        fst.d   f12, C_DEPTH(r6)
        adds    C_BYTES, r6, r6
        bri     r1
        mov     1, r7
beyond: bri    r1
        mov     r0, r7
