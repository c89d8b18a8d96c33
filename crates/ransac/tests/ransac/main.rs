//! The engine from outside: what it finds, what it reports, what hostile input and parts do to it.

mod allocation;
mod covariance;
mod documents;
mod engine;
mod hostile;
mod lines;
mod near_best;
mod numbers;
mod prior_knowledge;
mod reproducible;
mod scores;
mod structures;
mod tiling;
