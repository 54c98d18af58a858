// Draws the primitives of one view. The code calls the kernel of the view once for each sequence of consecutive primitives
// that the view draws (sort_rules.md, rule 5). Such a sequence is called a run.
//
// In: r16 to r20 and r2 as for a kernel: r16 first primitive, r17 number of primitives, r18 destination of the commands,
// r19 table of bins, r20 parameter block, r2 stack. Also: r21 words of the primitives (written by sort.s), r22 bit of the
// view in these words, r23 address of the kernel, r24 bytes of a primitive.
// Out: r18 address after the last command.

// ---- stack frame, below the stack frame of the clipper
SAVE    = -2560     // return address
NEXT    = -2556     // first primitive after the run
LEFT    = -2552     // number of primitives after the run
WORDS   = -2548     // words of these primitives
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
