// As bins_scheduled.s for frames of any size: each edge's greatest value over a region from that over the one before. Multiplications are
// left for the place of the first region and for regions that are cut off.
//
// In: low and high x, low and high y in r24 to r27; edges in the command at r18; table of bins r19.
// Out: number of regions r22. Changes r4 to r15, r23 to r31, f8 to f13.

// a and b times 128, and the greatest value over region 0, 0: its right side where a > 0, its last line where b > 0
        .macro  greatest k, a, b, c
        edgeword \k, 0, \a
        edgeword \k, 1, \b
        edgeword \k, 2, \c
        shra    31, \a, r23
        andnot  r23, \a, r23
        shl     7, r23, r28
        subs    r28, r23, r28
        adds    r28, \c, \c
        shra    31, \b, r23
        andnot  r23, \b, r23
        shl     7, r23, r28
        subs    r28, r23, r28
        adds    r28, \c, \c
        shl     7, \a, \a
        shl     7, \b, \b
        .endm

// a region has r28 columns or lines less
        .macro  shorter b, c
        shra    31, \b, r23
        andnot  r23, \b, r23
        shr     7, r23, r23
        ixfr    r23, f8
        ixfr    r28, f10
        fmlow.dd f8, f10, f12
        fxfr    f12, r23
        subs    \c, r23, \c
        .endm

// r28 = what the last of the regions lacks, the last subpixel being in r28
        .macro  lacking
        shr     4, r28, r28
        and     127, r28, r28
        subs    127, r28, r28
        .endm

// first pixel whose centre is not before a low side, last one before a high side
        .macro  firstpixel r
        adds    7, \r, \r
        shra    4, \r, \r
        shra    31, \r, r23
        andnot  r23, \r, \r
        .endm
        .macro  lastpixel r, most
        ld.l    \most(r20), r29
        adds    -9, \r, \r
        shra    4, \r, \r
        shr     4, r29, r29
        subs    r29, \r, r23
        shra    31, r23, r28
        and     r28, r23, r23
        adds    r23, \r, \r
        .endm

        .align  32
bins:   firstpixel r24
        lastpixel r25, P_LAST_X
        firstpixel r26
        lastpixel r27, P_LAST_Y
        mov     r0, r22
        subs    r25, r24, r23
        subs    r27, r26, r28
        or      r23, r28, r23
        subs    r23, r0, r0
        bc      nowhere                     // 0 > the difference: no pixel
        shr     7, r24, r24
        shr     7, r25, r25
        shr     7, r26, r26
        shr     7, r27, r27
        greatest 0, r5, r8, r11
        greatest 1, r6, r9, r12
        greatest 2, r7, r10, r13
        bte     r0, r24, column             // to the first column
        mov     r24, r29
left:   adds    -1, r29, r29
        adds    r5, r11, r11
        adds    r6, r12, r12
        adds    r7, r13, r13
        btne    r0, r29, left
column: bte     r0, r26, row                // to the first row
        mov     r26, r29
above:  adds    -1, r29, r29
        adds    r8, r11, r11
        adds    r9, r12, r12
        adds    r10, r13, r13
        btne    r0, r29, above
row:    regionnumber r26, r24               // place of the first region in the table
        shl     2, r28, r31
        adds    r19, r31, r31
rows:   ld.l    P_LAST_Y(r20), r28
        nop
        shr     11, r28, r23
        btne    r23, r26, whole
        lacking
        bte     r0, r28, whole
        shorter r8, r11
        shorter r9, r12
        shorter r10, r13
whole:  mov     r11, r14
        mov     r12, r15
        mov     r13, r4
        mov     r31, r30
        mov     r24, r29
columns: ld.l   P_LAST_X(r20), r28
        nop
        shr     11, r28, r23
        btne    r23, r29, full
        lacking
        bte     r0, r28, full
        shorter r5, r14
        shorter r6, r15
        shorter r7, r4
full:   or      r14, r15, r23
        or      r4, r23, r23
        adds    1, r29, r28
        subs    r23, r0, r0
        bc      beside                      // 0 > a value
        ld.l    0(r30), r23
        adds    1, r22, r22
        st.l    r18, 0(r23)
        adds    4, r23, r23
        st.l    r23, 0(r30)
beside: bte     r25, r29, below             // the last column
        mov     r28, r29
        adds    r5, r14, r14
        adds    r6, r15, r15
        adds    r7, r4, r4
        br      columns
        adds    4, r30, r30
below:  adds    r8, r11, r11
        adds    r9, r12, r12
        adds    r10, r13, r13
        ld.l    P_COLUMNS(r20), r23
        nop
        shl     2, r23, r23
        adds    r23, r31, r31
        bte     r27, r26, nowhere           // the last row
        br      rows
        adds    1, r26, r26
nowhere: bri    r1
        nop
