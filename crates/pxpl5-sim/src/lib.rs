//! Discrete-event kernel: exact time, clocks, event queue, parameters with a stated origin.
