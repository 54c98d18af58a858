// What a token asks of a slave: the bin of its region, handed over as a chain of messages (crates/pxpl5-gp/kernels/ring_rules.md, rule 6).
// Commands stay where TRANSFORM put them; a message is a list of pieces, each an address and a length in words.
//
//   token  r16 region, r17 bins of its context (where commands of spheres begin; then of each region where its entries begin and end), r18
//          where pieces go, r19 where messages go (first piece, behind the last, length in words, nothing), r20 parameters
//          out: r16 number of messages
//
// Pieces and messages are written and never read here, so that no cache holds them.

P_TRIANGLE = 0          // words of a triangle's command, and of a sphere's
P_SPHERE   = 4
P_BEGIN    = 8          // what begins the region: address, words
P_AGAIN    = 16         // what begins every message but the first
P_END      = 24         // what ends the region
P_NOTHING  = 32         // words of a message that need not be sent
// MOST words of a message before what ends the region, and WHOLE with that come from the program that assembles it.

        .macro  piece address, words
        st.l    \address, 0(r18)
        st.l    \words, 4(r18)
        adds    8, r18, r18
        .endm

// closes a message of r27 words whose first piece is at r30
        .macro  closed
        st.l    r30, 0(r19)
        st.l    r18, 4(r19)
        st.l    r27, 8(r19)
        adds    16, r19, r19
        adds    1, r16, r16
        mov     r18, r30
        .endm

// begins another one
        .macro  opened
        ld.l    P_AGAIN+4(r20), r27
        ld.l    P_AGAIN(r20), r28
        bte     r0, r27, bare\@
        piece   r28, r27
bare\@:
        .endm

token:  shl     3, r16, r16
        adds    r17, r16, r21
        ld.l    4(r21), r22             // the next entry
        ld.l    8(r21), r23
        ld.l    0(r17), r24
        ld.l    P_TRIANGLE(r20), r25
        ld.l    P_SPHERE(r20), r26
        ld.l    P_BEGIN+4(r20), r27     // words of the message
        ld.l    P_BEGIN(r20), r28
        mov     r18, r30
        mov     r0, r16
        bte     r0, r27, begun
        piece   r28, r27
begun:  bte     r22, r23, ending
entry:  ld.l    0(r22), r29
        adds    4, r22, r22
        mov     r25, r31
        subu    r29, r24, r0            // triangles' commands lie before those of spheres
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
