// The software of a board for messages on the ring (ring_rules.md).
//
//   receive  handles the interrupt of the ring interface. Then takes one message and gives it back, as a program does.
//            out: r16 queue entry, or 0 if there was none; r17 address of the message's words, or the fault; r18 number
//                 of words; r19 sender
//   send     r16 requests of four words (receiver; flags; length in words; address), r17 number of requests, r18 ticket
//            out: r16 0 if the chain was started, otherwise the fault; r17 the request with the fault
//
// r2 is the stack. The program that assembles this file defines DATA and WINDOW.

// ---- variables of the software, at DATA
NODE      = 0           // port of this board
RX_NEXT   = 4           // descriptor of the next message
HEAD      = 8           // the oldest and the newest entry of the queue
TAIL      = 12
FREE      = 16          // a list of free entries
QUEUED    = 20
WRONG     = 24          // fault of a message that was discarded
TX_NEXT   = 28          // the next free descriptor of a chain
TX_ROOM   = 32          // number of free descriptors
ISSUED    = 36          // number of chains started, and number of chains known to be finished
FINISHED  = 40
COMPLETE  = 44          // ticket of the last finished chain
HANDLERS  = 64          // addresses of the handlers, by kind of message
CHAINS    = 128         // table of chains, by the lower bits of their number: number of descriptors, ticket
FRAME     = 384         // registers of the interrupted program

// ---- a queue entry
E_NEXT    = 0
E_WORDS   = 4
E_SENDER  = 8
E_PLACE   = 12
E_BUFFER  = 16          // descriptor of the buffer that the entry keeps, or 0
E_COPY    = 32

// ---- registers of the interface, at WINDOW
CAUSE     = 0           // not 0 if messages have arrived
CREDIT    = 4           // write the descriptor of a free buffer here
START     = 8           // write the first descriptor of a chain here
DONE      = 12          // number of chains sent

// ---- a descriptor of a received message: state (0 owned by the interface, 1 arrived, 2 kept by a queue entry); buffer
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
LAST      = 4           // flags: the last message of its chain; the caller sets all other flags

SHORT     = 8           // words of a message that is copied
IM        = 0x10        // psr: interrupts are enabled

// ---- faults
NO_LENGTH = 1
NO_KIND   = 2
NO_ENTRY  = 3
NO_ROOM   = 4

// ---- takes a message and gives it back, as a program does
receive:
        adds    -32, r2, r2
        st.l    r1, 0(r2)
        call    interrupt               // the program has waited for this interrupt
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

// Clears IM in psr. The old psr is in r28.
        .macro  masked
        ld.c    psr, r28
        andnot  IM, r28, r27
        st.c    r27, psr
        .endm

// ---- takes the oldest entry: r16 entry or 0, r17 address or fault, r18 words, r19 sender
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

// ---- frees the entry r16 and its buffer
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

// ---- the interrupt, for which r30 and r31 are reserved
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
        adds    8, r21, r18             // address after the header
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
        // Count the chains that have been sent.
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
        subu    15, r23, r0             // the table of chains has 16 places
        bnc     noroom
        ld.l    TX_NEXT(r30), r20
        mov     r17, r19                // number of requests left
        mov     r20, r26                // the first descriptor of the chain
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
        // The place of the chain in the table.
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
