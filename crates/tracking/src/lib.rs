//! Head motion, tracker models and prediction for head-mounted displays.
