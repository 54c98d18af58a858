//! Rendering Control: the pipeline of master and slave graphics processors under PPHIGS.
