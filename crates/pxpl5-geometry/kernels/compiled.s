// The main loop.

        .align  32
start:  st.l    r1, SAVE(r2)
        counted
next:   passover_straight
        mov     r16, r5
        adds    CORNERS, r2, r6
        mov     3, r4
each:   call    corner
        adds    -1, r4, r4
        bte     r0, r7, clip
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, each
        surfaces
        set_up  done
done:   adds    -1, r17, r17
        adds    LIST_STEP, r16, r16
        btne    r0, r17, next
        ld.l    SAVE(r2), r1
        nop
        bri     r1
        nop
clip:   ld.l    P_CLIPPER(r20), r6          // not wholly inside the guard band
        nop
        calli   r6
        nop
        br      done
        nop
