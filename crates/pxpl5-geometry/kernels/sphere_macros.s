// What the code of spheres is written with: tests, ranges of pixels, whole numbers of 64 bits. Registers and frame stand in sphere.s.

// to `drop` unless |v| <= f12
        .macro  limited v
        pfle.dd \v, f12, f0
        bc      drop
        fsub.dd f0, \v, f14
        pfle.dd f14, f12, f0
        bc      drop
        .endm

// to `drop` if the number with this high word is none, or infinite
        .macro  finite high
        fxfr    \high, r8
        andh    0x7FF0, r8, r8
        xorh    0x7FF0, r8, r8
        bc      drop
        .endm

// eye coordinate k of the point in f16 f17 f18
        .macro  eye k, to
        fld.l   S_ROWS+16*\k(r20), f8
        fld.l   S_ROWS+16*\k+4(r20), f9
        fmul.ss f8, f16, \to
        fld.l   S_ROWS+16*\k+8(r20), f10
        fmul.ss f9, f17, f12
        fld.l   S_ROWS+16*\k+12(r20), f11
        fadd.ss \to, f12, \to
        fmul.ss f10, f18, f12
        fadd.ss \to, f12, \to
        fadd.ss \to, f11, \to
        .endm

// pixel coordinate k of an eye coordinate
        .macro  pixel k, from
        fld.d   S_CORNER+8*\k(r20), f8
        fld.d   S_RATE+8*\k(r20), f10
        fsub.dd \from, f8, f8
        fmul.dd f8, f10, f8
        fst.d   f8, ORIGIN+8*\k(r2)
        .endm

// a coefficient in f8 times the square of the bulge
        .macro  scaled to
        fmul.dd f8, f18, f8
        fst.d   f8, \to(r2)
        .endm

// first and last pixel of the ellipse along axis k
        .macro  extent k, first, last
        fld.d   SQUARES+8*\k(r2), f16
        call    root
        nop
        fst.d   f18, PER+8*\k(r2)
        fmul.dd f16, f18, f18
        fld.d   PEAK+8*\k(r2), f10
        fsub.dd f10, f18, f12
        fadd.dd f10, f18, f14
        finite  f13
        finite  f15
        fld.d   S_SLACK(r20), f16
        fld.d   S_MOST_PIXEL(r20), f18
        fsub.dd f12, f16, f12
        fadd.dd f14, f16, f14
        fsub.dd f0, f18, f20
        within  f12
        within  f14
        fld.d   S_ROUND(r20), f16
        fadd.dd f12, f16, f18               // up
        fxfr    f18, \first
        fsub.dd f18, f16, f18
        pfgt.dd f12, f18, f0
        bnc     up\@
        adds    1, \first, \first
up\@:   fadd.dd f14, f16, f18               // down
        fxfr    f18, \last
        fsub.dd f18, f16, f18
        pfgt.dd f18, f14, f0
        bnc     down\@
        adds    -1, \last, \last
down\@:
        .endm

// v between f20 and f18
        .macro  within v
        pfgt.dd \v, f20, f0
        bc      low\@
        fmov.dd f20, \v
low\@:  pfgt.dd f18, \v, f0
        bc      high\@
        fmov.dd f18, \v
high\@:
        .endm

// r from 0 to `most`
        .macro  clamped r, most
        subs    r0, \r, r0
        bc      low\@                       // r > 0
        mov     r0, \r
low\@:  subs    \most, \r, r0
        bnc     high\@
        mov     \most, \r
high\@:
        .endm

// a range from 0, its end brought to the picture by `atmost`; to `drop` if nothing is left
        .macro  clipped first, last, atmost
        subs    r0, \first, r0
        bc      above\@                     // first > 0
        mov     r0, \first
above\@: \atmost \last
        subs    \last, \first, r0
        bc      drop
        .endm

// an integer of at least 0 as a double: r30 is the high word of 2^52, f10 that number
        .macro  double r, to
        ixfr    \r, f8
        ixfr    r30, f9
        fsub.dd f8, f10, f8
        fst.d   f8, \to(r2)
        .endm

// the pixel nearest to the peak along axis k
        .macro  nearest k, first, last, word
        fld.d   \first(r2), f20
        fld.d   \last(r2), f18
        fld.d   PEAK+8*\k(r2), f12
        within  f12
        fadd.dd f12, f16, f12
        fxfr    f12, r8
        fsub.dd f12, f16, f12
        st.l    r8, \word(r2)
        st.l    r0, \word+4(r2)
        fst.d   f12, PIXEL+8*\k(r2)
        .endm

// the greatest |value| so far, f30, and that at a corner
        .macro  greater x, y
        fld.d   \x(r2), f8
        fld.d   ORIGIN(r2), f12
        fld.d   \y(r2), f10
        fsub.dd f8, f12, f8
        fld.d   ORIGIN+8(r2), f12
        call    value
        fsub.dd f10, f12, f10
        fsub.dd f0, f12, f14
        pfgt.dd f12, f30, f0
        bnc     less\@
        fmov.dd f12, f30
less\@: pfgt.dd f14, f30, f0
        bnc     lesser\@
        fmov.dd f14, f30
lesser\@:
        .endm

// the whole number of 64 bits nearest to a times f28; 1.5 * 2^52 in f30
        .macro  whole a
        fmul.dd \a, f28, \a
        fadd.dd \a, f30, \a
        fisub.dd \a, f30, \a
        .endm

// to = the number of 64 bits in low and high, times the small one p; f9, f11 and f14 are 0
        .macro  times low, high, p, to
        fmov.ss \low, f8
        fmov.ss \high, f10
        fmlow.dd f8, \p, \to
        fmlow.dd f10, \p, f12
        fmov.ss f12, f15
        fiadd.dd \to, f14, \to
        .endm

// words m and n of the command
        .macro  heads m, n
        ld.l    S_WORDS+4*\m(r20), r8
        ld.l    S_WORDS+4*\n(r20), r9
        st.l    r8, 4*\m(r18)
        st.l    r9, 4*\n(r18)
        .endm
