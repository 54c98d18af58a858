// The software of messages of a board (ring_rules.md).
//
//   receive  the interrupt of the ring interface, and what a program does to take one message and to give it back
//            out: r16 queue entry, 0 if there was none; r17 where the words of the message are, or what was wrong with it; r18 how
//            many; r19 sender
//   send     r16 requests of four words (receiver; flags; length in words; address), r17 how many, r18 ticket
//            out: r16 0 if the chain was started, otherwise what is wrong; r17 which request
//
// r2 is a stack. DATA and WINDOW come from the program that assembles it.

// ---- what the software keeps, at DATA
NODE      = 0           // port of this board
RX_NEXT   = 4           // descriptor of the next message
HEAD      = 8           // the oldest and the newest entry of the queue
TAIL      = 12
FREE      = 16          // a list of free entries
QUEUED    = 20
WRONG     = 24          // what was wrong with a message that was thrown away
TX_NEXT   = 28          // the next free descriptor of a chain
TX_ROOM   = 32          // how many are free
ISSUED    = 36          // chains started, and those known to be finished
FINISHED  = 40
COMPLETE  = 44          // ticket of the last of them
HANDLERS  = 64          // by kind
CHAINS    = 128         // by the lower bits of their number: descriptors, ticket
FRAME     = 384         // registers of what was interrupted

// ---- a queue entry
E_NEXT    = 0
E_WORDS   = 4
E_SENDER  = 8
E_PLACE   = 12
E_BUFFER  = 16          // descriptor of the buffer that it keeps, or 0
E_COPY    = 32

// ---- registers of the interface, at WINDOW
CAUSE     = 0           // not 0 when messages have arrived
CREDIT    = 4           // takes the descriptor of a buffer that is free again
START     = 8           // takes the first descriptor of a chain
DONE      = 12          // chains sent

// ---- a descriptor of a received message: 0 the interface's, 1 it has arrived, 2 a queue entry keeps it; buffer
D_OWNER   = 0
D_BUFFER  = 4
D_BYTES   = 16
RX        = WINDOW+256
RX_END    = RX+RX_COUNT*D_BYTES

// ---- a descriptor of a message in a chain: flags, header, address
T_FLAGS   = 0
T_HEADER  = 4
T_ADDRESS = 12
TX        = WINDOW+0x1000
TX_END    = TX+TX_COUNT*D_BYTES
LAST      = 4           // flags: the last of its chain; the others are the caller's

SHORT     = 8           // words of a message that is copied
IM        = 0x10        // psr: interrupts are taken

// ---- faults
NO_LENGTH = 1
NO_KIND   = 2
NO_ENTRY  = 3
NO_ROOM   = 4

// ---- a program takes a message and gives it back
receive:
        adds    -32, r2, r2
        st.l    r1, 0(r2)
        call    interrupt               // what it waited for
        nop
        call    take
        nop
        bte     r0, r16, received
        st.l    r16, 4(r2)
        st.l    r17, 8(r2)
        st.l    r18, 12(r2)
        st.l    r19, 16(r2)
        call    release
        nop
        ld.l    4(r2), r16
        ld.l    8(r2), r17
        ld.l    12(r2), r18
        ld.l    16(r2), r19
received:
        ld.l    0(r2), r1
        bri     r1
        adds    32, r2, r2

// psr without IM; the old one in r28
        .macro  masked
        ld.c    psr, r28
        andnot  IM, r28, r27
        st.c    r27, psr
        .endm

// ---- takes the oldest entry: r16 entry or 0, r17 place or fault, r18 words, r19 sender
take:   mov     DATA, r30
        masked
        ld.l    HEAD(r30), r16
        bte     r0, r16, nothing
        ld.l    E_NEXT(r16), r20
        ld.l    QUEUED(r30), r21
        st.l    r20, HEAD(r30)
        adds    -1, r21, r21
        st.l    r21, QUEUED(r30)
        btne    r0, r20, taken
        st.l    r0, TAIL(r30)
taken:  ld.l    E_PLACE(r16), r17
        ld.l    E_WORDS(r16), r18
        ld.l    E_SENDER(r16), r19
        bri     r1
        st.c    r28, psr
nothing:
        ld.l    WRONG(r30), r17
        st.l    r0, WRONG(r30)
        bri     r1
        st.c    r28, psr

// ---- gives the entry r16 back, and its buffer
release:
        mov     DATA, r30
        masked
        ld.l    E_BUFFER(r16), r17
        ld.l    FREE(r30), r18
        bte     r0, r17, kept
        mov     WINDOW, r29
        st.l    r0, D_OWNER(r17)
        st.l    r17, CREDIT(r29)
kept:   st.l    r18, E_NEXT(r16)
        st.l    r16, FREE(r30)
        bri     r1
        st.c    r28, psr

// ---- the interrupt; r30 and r31 are its own
interrupt:
        mov     DATA, r30
        st.l    r1, FRAME(r30)
        st.l    r16, FRAME+4(r30)
        st.l    r17, FRAME+8(r30)
        st.l    r18, FRAME+12(r30)
        st.l    r19, FRAME+16(r30)
        st.l    r20, FRAME+20(r30)
        st.l    r21, FRAME+24(r30)
        st.l    r22, FRAME+28(r30)
        st.l    r23, FRAME+32(r30)
        st.l    r24, FRAME+36(r30)
        st.l    r25, FRAME+40(r30)
        st.l    r26, FRAME+44(r30)
        st.l    r27, FRAME+48(r30)
        st.l    r28, FRAME+52(r30)
        st.l    r29, FRAME+56(r30)
        ld.c    psr, r16
        ld.c    fir, r17
        st.l    r16, FRAME+60(r30)
        st.l    r17, FRAME+64(r30)
        mov     WINDOW, r29
        ld.l    CAUSE(r29), r16
        bte     r0, r16, resume
        st.l    r0, CAUSE(r29)
        ld.l    RX_NEXT(r30), r20
arrived:
        ld.l    D_OWNER(r20), r16
        btne    1, r16, drained
        ld.l    D_BUFFER(r20), r21
        ld.l    0(r21), r22             // receiver and sender
        ld.l    4(r21), r23             // kind and length
        and     0xFFFF, r23, r25
        adds    -1, r25, r26
        subu    1023, r26, r0           // 1 to 1,024 words
        bnc     wronglength
        shr     16, r23, r24
        subu    2, r24, r0
        bnc     wrongkind
        shl     2, r24, r24
        adds    r30, r24, r24
        ld.l    HANDLERS(r24), r28
        calli   r28
        nop
follow: adds    D_BYTES, r20, r20
        mov     RX_END, r16
        btne    r16, r20, arrived
        mov     RX, r20
        br      arrived
        nop
drained:
        st.l    r20, RX_NEXT(r30)
resume: ld.l    FRAME+60(r30), r31
        ld.l    FRAME(r30), r1
        ld.l    FRAME+4(r30), r16
        ld.l    FRAME+8(r30), r17
        ld.l    FRAME+12(r30), r18
        ld.l    FRAME+16(r30), r19
        ld.l    FRAME+20(r30), r20
        ld.l    FRAME+24(r30), r21
        ld.l    FRAME+28(r30), r22
        ld.l    FRAME+32(r30), r23
        ld.l    FRAME+36(r30), r24
        ld.l    FRAME+40(r30), r25
        ld.l    FRAME+44(r30), r26
        ld.l    FRAME+48(r30), r27
        ld.l    FRAME+52(r30), r28
        ld.l    FRAME+56(r30), r29
        st.c    r31, psr
        bri     r1
        nop

wronglength:
        mov     NO_LENGTH, r16
        br      refused
        nop
wrongkind:
        mov     NO_KIND, r16
refused:
        st.l    r16, WRONG(r30)
        st.l    r0, D_OWNER(r20)
        st.l    r20, CREDIT(r29)
        br      follow
        nop

// ---- handlers: descriptor r20, buffer r21, header r22 r23, words r25
nohandler:
        mov     NO_KIND, r16
        st.l    r16, WRONG(r30)
        st.l    r0, D_OWNER(r20)
        bri     r1
        st.l    r20, CREDIT(r29)

queue:  ld.l    FREE(r30), r16
        bte     r0, r16, noentry
        ld.l    E_NEXT(r16), r17
        ld.l    TAIL(r30), r19
        st.l    r17, FREE(r30)
        st.l    r0, E_NEXT(r16)
        and     0xFFFF, r22, r18
        st.l    r25, E_WORDS(r16)
        st.l    r18, E_SENDER(r16)
        st.l    r16, TAIL(r30)
        bte     r0, r19, alone
        br      linked
        st.l    r16, E_NEXT(r19)
alone:  st.l    r16, HEAD(r30)
linked: ld.l    QUEUED(r30), r17
        adds    8, r21, r18             // behind the header
        adds    1, r17, r17
        st.l    r17, QUEUED(r30)
        subu    SHORT, r25, r0
        bnc     long
        adds    E_COPY, r16, r19
        st.l    r19, E_PLACE(r16)
        st.l    r0, E_BUFFER(r16)
copied: ld.l    0(r18), r17
        adds    4, r18, r18
        adds    -1, r25, r25
        st.l    r17, 0(r19)
        adds    4, r19, r19
        btne    r0, r25, copied
        st.l    r0, D_OWNER(r20)
        bri     r1
        st.l    r20, CREDIT(r29)
long:   mov     2, r17
        st.l    r18, E_PLACE(r16)
        st.l    r17, D_OWNER(r20)
        bri     r1
        st.l    r20, E_BUFFER(r16)
noentry:
        mov     NO_ENTRY, r17
        st.l    r17, WRONG(r30)
        st.l    r0, D_OWNER(r20)
        bri     r1
        st.l    r20, CREDIT(r29)

// ---- builds a chain and starts it
send:   bte     r0, r17, empty
        mov     DATA, r30
        mov     WINDOW, r29
        masked
        // what has been sent
        ld.l    DONE(r29), r19
        ld.l    FINISHED(r30), r20
        ld.l    TX_ROOM(r30), r21
        bte     r19, r20, known
finished:
        and     15, r20, r22
        shl     3, r22, r22
        adds    r30, r22, r22
        ld.l    CHAINS(r22), r23
        ld.l    CHAINS+4(r22), r24
        adds    1, r20, r20
        adds    r23, r21, r21
        st.l    r24, COMPLETE(r30)
        btne    r19, r20, finished
        st.l    r20, FINISHED(r30)
known:  subu    r21, r17, r0
        bnc     noroom
        ld.l    ISSUED(r30), r23
        ld.l    NODE(r30), r22
        subs    r23, r20, r23
        subu    15, r23, r0             // chains that are noted
        bnc     noroom
        ld.l    TX_NEXT(r30), r20
        mov     r17, r19                // still to come
        mov     r20, r26                // the first
        mov     TX_END, r27
link:   ld.l    8(r16), r23
        adds    -1, r23, r24
        subu    1023, r24, r0
        bnc     badlength
        ld.l    0(r16), r24             // receiver
        ld.l    4(r16), r25             // flags, kind
        shl     16, r24, r24
        or      r22, r24, r24
        st.l    r24, T_HEADER(r20)
        andh    0xFFFF, r25, r24
        or      r23, r24, r24
        st.l    r24, T_HEADER+4(r20)
        ld.l    12(r16), r24
        and     0xFFFF, r25, r25
        st.l    r24, T_ADDRESS(r20)
        adds    -1, r19, r19
        btne    r0, r19, more
        or      LAST, r25, r25
more:   st.l    r25, T_FLAGS(r20)
        adds    D_BYTES, r20, r20
        adds    16, r16, r16
        btne    r20, r27, inside
        mov     TX, r20
inside: btne    r0, r19, link
        // the chain as a whole
        ld.l    ISSUED(r30), r23
        subs    r21, r17, r21
        st.l    r20, TX_NEXT(r30)
        st.l    r21, TX_ROOM(r30)
        and     15, r23, r24
        shl     3, r24, r24
        adds    r30, r24, r24
        st.l    r17, CHAINS(r24)
        st.l    r18, CHAINS+4(r24)
        adds    1, r23, r23
        st.l    r23, ISSUED(r30)
        st.l    r26, START(r29)
        st.c    r28, psr
empty:  bri     r1
        mov     r0, r16
noroom: st.l    r21, TX_ROOM(r30)
        mov     NO_ROOM, r16
        bri     r1
        st.c    r28, psr
badlength:
        st.l    r21, TX_ROOM(r30)
        subs    r17, r19, r17
        mov     NO_LENGTH, r16
        bri     r1
        st.c    r28, psr
