//! What a file holds that was opened: a map, or a trace of any kind.

use host_sim::record::TraceError;
use host_sim::record::grid::Trace;
use host_sim::record::heights;
use host_sim::record::voxels::VoxelTrace;

use crate::maps::Map;

/// Out of a file.
pub(crate) enum Opened {
    /// A map to explore.
    Map(Map),
    /// What `explore`, or firmware in the loop, has left.
    Exploration(Box<Trace>),
    /// What `survey` has left of a terrain of heights.
    Survey(Box<heights::Trace>),
    /// What `survey` has left of a town of voxels.
    Voxels(Box<VoxelTrace>),
}

impl Opened {
    /// Reads a file by what it holds; its name tells the format of a map.
    ///
    /// # Errors
    /// What is wrong with it and what to do, in a sentence for the user.
    pub(crate) fn read(name: &str, bytes: &[u8]) -> Result<Self, String> {
        if bytes.starts_with(b"tick,") {
            return Err(format!(
                "{name}: is a trace or a curve without a scenario in its first line; run \
                 `host-sim explore` or `host-sim survey` and open the trace.csv that it writes"
            ));
        }
        if !bytes.starts_with(b"{") {
            return Map::from_bytes(name, bytes).map(Self::Map);
        }
        let is_summary = bytes.windows(14).any(|part| part == b"\"trace_digest\"");
        if is_summary {
            return Err(format!(
                "{name}: is the summary of a run, what came of it but not what happened; open \
                 the trace.csv that lies beside it"
            ));
        }
        let read = Trace::read(bytes).map(|trace| Self::Exploration(Box::new(trace)));
        let read = or(read, || {
            heights::Trace::read(bytes).map(|trace| Self::Survey(Box::new(trace)))
        });
        let read = or(read, || {
            VoxelTrace::read(bytes).map(|trace| Self::Voxels(Box::new(trace)))
        });
        read.map_err(|error| match error {
            TraceError::Format { reads, format, .. } if reads.name != format => format!(
                "{name}: is no trace of host-sim but `{format}`; open a trace.csv that \
                 `host-sim explore` or `host-sim survey` has written"
            ),
            error => format!("{name}: {error}"),
        })
    }
}

/// The next reader, if the file is a trace of another kind.
fn or(
    read: Result<Opened, TraceError>,
    next: impl Fn() -> Result<Opened, TraceError>,
) -> Result<Opened, TraceError> {
    match read {
        Err(TraceError::Format { reads, format, .. }) if reads.name != format => next(),
        read => read,
    }
}
