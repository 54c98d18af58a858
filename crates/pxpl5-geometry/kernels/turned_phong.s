// How normals of corners turn, for the kernels whose corners are structures in memory. place.s turns the rows themselves, in doubles and
// once for a structure: it has neither.

// r8 = r20 if three corners face the eye on the whole, else 24 more: what P_SIDES and the place behind it are found by. The first
// one's measure of turning away lies at `at` of the frame, the others `bytes` behind each other.
        .macro  sided at, bytes
        fld.l   \at(r2), f8
        fld.l   \at+\bytes(r2), f9
        fld.l   \at+2*\bytes(r2), f10
        fadd.ss f8, f9, f8
        mov     r20, r8
        fadd.ss f8, f10, f8
        pfgt.ss f8, f0, f0
        bnc     facing
        adds    24, r20, r8
facing:
        .endm

// f16 = the normal in f20 f21 f22 along the axis of the eye whose row is at r11, less the block's P_EYE; r11 to the next, r9 one less
        .macro  alongaxis
        fld.l   P_EYE(r11), f16
        fld.l   P_EYE+4(r11), f17
        fld.l   P_EYE+8(r11), f18
        adds    -1, r9, r9
        fmul.ss f16, f20, f16
        fmul.ss f17, f21, f17
        fadd.ss f16, f17, f16
        fmul.ss f18, f22, f18
        adds    16, r11, r11
        fadd.ss f16, f18, f16
        .endm

