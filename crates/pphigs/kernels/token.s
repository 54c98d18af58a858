// Answers a token: divides the bin of a region into messages, which the DMA then sends as one chain
// (crates/pxpl5-gp/kernels/ring_rules.md, rule 6). The commands stay where TRANSFORM wrote them. A message is a list of
// pieces. A piece is an address and a length in words.
//
//   token  In: r16 number of the region, r17 table of the bins of its context, r18 memory for the pieces, r19 memory for
//          the messages, r20 parameters (P_TRIANGLE to P_NOTHING).
//          Out: r16 number of messages.
//
// The first word of the table of bins is the address at which the commands of spheres begin. For each region, two words
// follow: the addresses of the first entry and of the end of the entries. An entry is the address of a command.
//
// A message has four words: the addresses of the first piece and of the end of the pieces, the length in words, and an
// unused word. This code writes pieces and messages but never reads them, so the data cache does not fill with them.

P_TRIANGLE = 0          // words of a triangle's command and of a sphere's command
P_SPHERE   = 4
P_BEGIN    = 8          // commands at the start of the region: address, number of words
P_AGAIN    = 16         // commands at the start of every message after the first message
P_END      = 24         // commands at the end of the region
P_NOTHING  = 32         // a message of at most this number of words is not sent
// The Rust code that assembles this file defines two maxima. A message has at most MOST words without the commands at the
// end of the region, and at most WHOLE words with these commands.

        .macro  piece address, words
        st.l    \address, 0(r18)
        st.l    \words, 4(r18)
        adds    8, r18, r18
        .endm

// Ends a message of r27 words, whose first piece is at r30.
        .macro  closed
        st.l    r30, 0(r19)
        st.l    r18, 4(r19)
        st.l    r27, 8(r19)
        adds    16, r19, r19
        adds    1, r16, r16
        mov     r18, r30
        .endm

// Begins another message, with r27 words so far.
        .macro  opened
        ld.l    P_AGAIN+4(r20), r27
        ld.l    P_AGAIN(r20), r28
        bte     r0, r27, bare\@
        piece   r28, r27
bare\@:
        .endm

token:  shl     3, r16, r16
        adds    r17, r16, r21
        ld.l    4(r21), r22             // the next entry of the bin, and the end of the entries
        ld.l    8(r21), r23
        ld.l    0(r17), r24
        ld.l    P_TRIANGLE(r20), r25
        ld.l    P_SPHERE(r20), r26
        ld.l    P_BEGIN+4(r20), r27     // words of the message so far
        ld.l    P_BEGIN(r20), r28
        mov     r18, r30
        mov     r0, r16
        bte     r0, r27, begun
        piece   r28, r27
begun:  bte     r22, r23, ending
entry:  ld.l    0(r22), r29
        adds    4, r22, r22
        mov     r25, r31
        subu    r29, r24, r0            // the commands of triangles lie before the commands of spheres
        bnc     sized
        mov     r26, r31
sized:  adds    r31, r27, r28
        subu    MOST, r28, r0
        bc      fitting
        closed
        opened
        adds    r31, r27, r28
fitting:
        piece   r29, r31
        mov     r28, r27
        btne    r22, r23, entry
ending: ld.l    P_END+4(r20), r31
        ld.l    P_END(r20), r29
        bte     r0, r31, ended
        adds    r31, r27, r28
        subu    WHOLE, r28, r0
        bc      last
        closed
        opened
        adds    r31, r27, r28
last:   piece   r29, r31
        mov     r28, r27
ended:  ld.l    P_NOTHING(r20), r28
        subu    r28, r27, r0
        bc      silent
        closed
silent: bri     r1
        nop
