// A command: enable; three edges; depth compared, depth loaded again; red, green, blue.
COMMAND_BYTES = 120

// Nothing follows the planes.
        .macro  finish
        .endm
