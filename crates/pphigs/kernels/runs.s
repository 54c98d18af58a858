// The primitives that a view is given, to its kernel in runs of neighbours (sort_rules.md, rule 5).
//
// In: as a kernel (r16 first primitive, r17 how many, r18 where commands go, r19 table of bins, r20 parameter block, r2 stack); r21 the
// primitives' words, r22 the view's bit, r23 the kernel, r24 bytes of a primitive. Out: r18 behind the last command.

// ---- stack frame, below that of the clipper
SAVE    = -2560     // return address
NEXT    = -2556     // first primitive behind the run
LEFT    = -2552     // how many are left there
WORDS   = -2548     // their words
BIT     = -2544
KERNEL  = -2540
STEP    = -2536

        .align  32
runs:   st.l    r1, SAVE(r2)
        st.l    r22, BIT(r2)
        st.l    r23, KERNEL(r2)
        st.l    r24, STEP(r2)
seek:   bte     r0, r17, over
        ld.l    0(r21), r5
        adds    4, r21, r21
        adds    -1, r17, r17
        and     r5, r22, r5
        btne    r0, r5, found
        br      seek
        adds    r24, r16, r16
found:  mov     r16, r6
        mov     1, r7
        adds    r24, r16, r16
more:   bte     r0, r17, run
        ld.l    0(r21), r5
        nop
        and     r5, r22, r5
        bte     r0, r5, run
        adds    4, r21, r21
        adds    -1, r17, r17
        adds    1, r7, r7
        br      more
        adds    r24, r16, r16
run:    st.l    r16, NEXT(r2)
        st.l    r17, LEFT(r2)
        st.l    r21, WORDS(r2)
        mov     r6, r16
        calli   r23
        mov     r7, r17
        ld.l    NEXT(r2), r16
        ld.l    LEFT(r2), r17
        ld.l    WORDS(r2), r21
        ld.l    BIT(r2), r22
        ld.l    KERNEL(r2), r23
        ld.l    STEP(r2), r24
        br      seek
        nop
over:   ld.l    SAVE(r2), r1
        nop
        bri     r1
        nop
