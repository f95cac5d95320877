//! Recordings (MCAP) that Foxglove, `PlotJuggler`, Rerun and `ros2 bag` open.

use std::collections::BTreeMap;
use std::io::{Seek, Write};

use mcap::read::Options;
use mcap::records::MessageHeader;
use mcap::{MessageStream, WriteOptions, Writer};

use crate::Message;

/// Why something was not recorded, or is not read.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The file cannot be written.
    #[error("the recording cannot be written: {0}")]
    File(#[from] mcap::McapError),
    /// The message has no bytes.
    #[error("a message cannot be encoded or decoded: {0}")]
    Bytes(#[from] cdr_encoding::Error),
    /// The recording is damaged or compressed.
    #[error("{0}")]
    Unread(mcap::McapError),
}

/// A message of a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recorded {
    /// Its topic.
    pub topic: String,
    /// Its type, such as `sensor_msgs/msg/LaserScan`.
    pub kind: String,
    /// As [`Message::from_bytes`] takes it.
    pub bytes: Vec<u8>,
}

/// The messages of a recording, in their order. One without an end is read as far as it goes.
///
/// # Errors
/// What is no recording; message by message, what is damaged or compressed.
pub fn recorded(
    bytes: &[u8],
) -> Result<impl Iterator<Item = Result<Recorded, RecordingError>>, RecordingError> {
    if !bytes.starts_with(mcap::MAGIC) {
        return Err(RecordingError::Unread(mcap::McapError::BadMagic));
    }
    let options = Options::IgnoreEndMagic.into();
    let messages = MessageStream::new_with_options(bytes, options);
    Ok(messages.map_err(RecordingError::Unread)?.map(|message| {
        let message = message.map_err(RecordingError::Unread)?;
        let kind = message.channel.schema.as_ref();
        Ok(Recorded {
            topic: message.channel.topic.clone(),
            kind: kind.map_or(String::new(), |schema| schema.name.clone()),
            bytes: message.data.into_owned(),
        })
    }))
}

/// A recording that grows message by message. Without [`finish`](Self::finish) it has no
/// index, and readers have to recover it.
pub struct Recording<W: Write + Seek> {
    writer: Writer<W>,
    /// By the topic's name; each counts its messages.
    channels: BTreeMap<String, (u16, u32)>,
}

impl<W: Write + Seek> Recording<W> {
    /// Begins one.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn new(to: W) -> Result<Self, RecordingError> {
        let options = WriteOptions::new().profile("ros2").compression(None);
        Ok(Self {
            writer: options.create(to)?,
            channels: BTreeMap::new(),
        })
    }

    /// Adds a message of a topic; `nanoseconds` is when it was sent.
    ///
    /// # Errors
    /// It cannot be written, or another type was recorded on this topic.
    pub fn add<M: Message>(
        &mut self,
        topic: &str,
        nanoseconds: u64,
        message: &M,
    ) -> Result<(), RecordingError> {
        if !self.channels.contains_key(topic) {
            let name = format!("{}/msg/{}", M::PACKAGE, M::NAME);
            let definition = M::definition();
            let schema = self
                .writer
                .add_schema(&name, "ros2msg", definition.as_bytes())?;
            let channel = self
                .writer
                .add_channel(schema, topic, "cdr", &BTreeMap::new())?;
            self.channels.insert(topic.to_owned(), (channel, 0));
        }
        let bytes = message.to_bytes()?;
        let Some((channel_id, sequence)) = self.channels.get_mut(topic) else {
            return Ok(());
        };
        *sequence = sequence.wrapping_add(1);
        let header = MessageHeader {
            channel_id: *channel_id,
            sequence: *sequence,
            log_time: nanoseconds,
            publish_time: nanoseconds,
        };
        Ok(self.writer.write_to_known_channel(&header, &bytes)?)
    }

    /// Ends the recording with its index, and gives back what it was written to.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn finish(mut self) -> Result<W, RecordingError> {
        self.writer.finish()?;
        Ok(self.writer.into_inner())
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::geometry::Twist;
    use crate::std_msgs::Bool;

    #[test]
    fn what_was_recorded_is_read_in_its_order() {
        let mut recording = Recording::new(Cursor::new(Vec::new())).unwrap();
        let yes = Bool { data: true };
        recording.add("/go", 5, &yes).unwrap();
        recording.add("/cmd_vel", 6, &Twist::default()).unwrap();
        recording.add("/go", 7, &Bool::default()).unwrap();
        let bytes = recording.finish().unwrap().into_inner();
        let messages: Vec<_> = mcap::MessageStream::new(&bytes)
            .unwrap()
            .collect::<Result<_, _>>()
            .unwrap();
        let topics = messages.iter().map(|it| (it.log_time, &*it.channel.topic));
        let topics: Vec<_> = topics.collect();
        assert_eq!(topics, [(5, "/go"), (6, "/cmd_vel"), (7, "/go")]);
        assert_eq!(messages[0].data[..], yes.to_bytes().unwrap());
        let schema = messages[0].channel.schema.as_ref().unwrap();
        assert_eq!(
            (&*schema.name, &*schema.encoding),
            ("std_msgs/msg/Bool", "ros2msg")
        );
        assert_eq!(schema.data[..], *b"bool data\n");
        let read: Vec<_> = recorded(&bytes).unwrap().map(Result::unwrap).collect();
        assert_eq!(Bool::from_bytes(&read[0].bytes).unwrap(), yes);
        assert_eq!(
            (&*read[1].topic, &*read[1].kind),
            ("/cmd_vel", "geometry_msgs/msg/Twist")
        );
        assert!(recorded(b"no recording").is_err());
        let sequences: Vec<_> = messages.iter().map(|it| it.sequence).collect();
        assert_eq!(sequences, [1, 1, 2]);
    }
}
