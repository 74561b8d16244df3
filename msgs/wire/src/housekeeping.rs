//! What nodes say of themselves. Travels under `@`, where `**` does not see it.

use crate::layout::{layout, message};
use crate::{Header, Latencies, Refusal};

layout! {
    /// What one input of a node has seen.
    pub struct InputHealth {
        /// The key of the topic.
        pub key: String,
        /// Messages taken.
        pub received: u64,
        /// Messages that never came or fell out of a full ring: gaps in `seq`.
        pub lost: u64,
        /// Messages that could not be read, or came twice.
        pub refused: u64,
    }
}

layout! {
    /// A node's own account, about once a second.
    pub struct Health {
        /// The stamp is of the newest message that the node has finished.
        pub header: Header,
        /// kind/instance.
        pub node: String,
        /// What came in.
        pub inputs: Vec<InputHealth>,
        /// Messages sent.
        pub published: u64,
        /// What the node refused, by reason, since its start.
        pub refused: Vec<Refusal>,
        /// Median of now - stamp when a result was sent, since the last report; 0 when no clock tells.
        pub latency_p50_nanos: i64,
        /// 99th percentile of the same.
        pub latency_p99_nanos: i64,
        /// All of them since the start.
        pub latencies: Latencies,
        /// Processor time used since the start.
        pub cpu_nanos: i64,
        /// Of the wall time since the start, how much was spent on messages rather than waiting.
        pub busy_nanos: i64,
    }
}
message!(Health @ 2);

layout! {
    /// How far a consumer has come; a source that is not bound to real time waits for it.
    pub struct Progress {
        /// The stamp of the newest message that the node has finished.
        pub header: Header,
        /// kind/instance.
        pub node: String,
        /// The number of that message on its own topic: a node that is started again counts from there.
        pub finished_seq: u64,
    }
}
message!(Progress @ 1);

layout! {
    /// Who should read a line of the log.
    pub enum LogLevel {
        /// Something was lost or has failed.
        Error,
        /// Worth a look.
        Warn,
        /// For the operator.
        Info,
        /// For whoever works on the node.
        Debug,
    }
}

layout! {
    /// A line of a node's log.
    pub struct LogLine {
        /// The stamp is the system clock's.
        pub header: Header,
        /// kind/instance.
        pub node: String,
        /// For whom.
        pub level: LogLevel,
        /// The line.
        pub text: String,
    }
}
message!(LogLine @ 1);
