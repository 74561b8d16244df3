//! Messages out of one chunk.

use mcap::records::Record;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, parse_record};

/// Unpacked, a chunk may be this much larger than packed (a black picture is), and this much in any case.
const MOST_FROM_A_BYTE: usize = 1 << 12;
const ALWAYS_ALLOWED_BYTES: usize = 1 << 24;
/// More than the largest message and the largest chunk together.
const MAX_BYTES: usize = 1 << 30;

/// The records in a chunk, given with its prefix. Nothing comes out of a chunk whose checksum is wrong.
pub(crate) fn records(chunk: &[u8]) -> Result<Vec<Record<'static>>, McapError> {
    let limit = chunk.len().saturating_mul(MOST_FROM_A_BYTE).clamp(ALWAYS_ALLOWED_BYTES, MAX_BYTES);
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(limit);
    let mut reader = LinearReader::new_with_options(options);
    let mut rest = chunk;
    let mut records = Vec::new();
    while let Some(event) = reader.next_event() {
        match event? {
            LinearReadEvent::ReadRequest(wanted) => {
                let (now, later) = rest.split_at(wanted.min(rest.len()));
                reader.insert(now.len()).copy_from_slice(now);
                reader.notify_read(now.len());
                rest = later;
            }
            LinearReadEvent::Record { opcode, data } => records.push(parse_record(opcode, data)?.into_owned()),
        }
    }
    Ok(records)
}
