//! The planner among voxels on a chip, as the survey sees it.

use bridge::{Request, VOXEL_LOOK, VoxelAnswer, VoxelReply, VoxelRequest, VoxelState, voxels_hash};
use planner_core::radio::{FrameError, MAX_LEN};
use planner_core::tile::TileIndex;
use planner_core::volume::{Content, Heading, Voxel, VoxelPatch};
use planner_core::voxel_survey::Config;
use planner_core::{Action, Extent, RobotId, Status};

use super::dialogue::Dialogue;
use super::swarm::Swarm;
use crate::measured::Call;
use crate::run::voxels::Pilot;

/// Passes each call on to the chip, and the chip's answer back, as a
/// [`Proxy`](super::proxy::Proxy) does.
pub(super) struct VoxelProxy {
    dialogue: Dialogue,
    /// Is told what the chip is told, and decides nothing: its map is that of the chip.
    mirror: Box<dyn Pilot>,
    /// What the chip said last of itself.
    state: VoxelState,
    work: u32,
}

impl VoxelProxy {
    /// `mirror` is a planner like the one on the chip.
    pub(super) fn new(swarm: &Swarm, mirror: Box<dyn Pilot>, planner: Config, id: RobotId) -> Self {
        let request = Request::Voxels {
            planner,
            id,
            extent: mirror.extent(),
            levels: mirror.levels(),
        };
        Self {
            dialogue: swarm.start(id, Ok(request)),
            state: VoxelState {
                status: mirror.status(),
                heading: mirror.heading(),
            },
            mirror,
            work: 0,
        }
    }

    /// Sends a request; `read` takes what is wanted out of the reply. `None` after a failure.
    fn ask<T>(
        &mut self,
        call: Option<Call>,
        request: &VoxelRequest<'_>,
        read: impl FnOnce(VoxelReply) -> Option<T>,
    ) -> Option<T> {
        let answer: VoxelAnswer = self.dialogue.ask(call, request)?;
        self.state = answer.state;
        let value = read(answer.reply);
        if value.is_none() {
            self.dialogue.misunderstood(request);
        }
        value
    }

    fn tell(&mut self, call: Option<Call>, request: &VoxelRequest<'_>) {
        self.ask(call, request, |reply| {
            matches!(reply, VoxelReply::Done).then_some(())
        });
    }
}

impl Drop for VoxelProxy {
    fn drop(&mut self) {
        let memory = self.ask(None, &VoxelRequest::Memory, |reply| match reply {
            VoxelReply::Memory(memory) => Some(memory),
            _ => None,
        });
        self.dialogue.close(memory, &VoxelRequest::End);
    }
}

impl Pilot for VoxelProxy {
    fn observe(&mut self, at: Voxel, heading: Heading, seen: &[(Voxel, bool)]) {
        self.mirror.observe(at, heading, seen);
        for voxels in seen.chunks(VOXEL_LOOK) {
            let voxels = voxels.iter().copied().collect();
            self.tell(None, &VoxelRequest::Look(voxels));
        }
        let request = VoxelRequest::Observe(at, heading);
        self.tell(Some(Call::Observe), &request);
    }

    fn heading(&self) -> Heading {
        self.state.heading
    }

    fn tick(&mut self) -> Action<Voxel, Voxel> {
        let call = Some(Call::Tick);
        let decided = self.ask(call, &VoxelRequest::Tick, |reply| match reply {
            VoxelReply::Decided { action, work, map } => Some((action, work, map)),
            _ => None,
        });
        let Some((action, work, map)) = decided else {
            return Action::Wait;
        };
        self.work = work;
        let mirror = &self.mirror;
        if map
            != voxels_hash(
                |tile, z| mirror.patch(tile, z),
                |tile, z| mirror.after(tile, z),
            )
        {
            self.dialogue.other_map();
        }
        action
    }

    fn work(&self) -> u32 {
        self.work
    }

    fn pass(&mut self) {
        self.tell(None, &VoxelRequest::Pass);
    }

    fn resume(&mut self) {
        self.tell(None, &VoxelRequest::Resume);
    }

    fn energy(&mut self, left: u32) {
        self.tell(None, &VoxelRequest::Energy(left));
    }

    fn status(&self) -> Status<Voxel> {
        self.state.status
    }

    fn hear(&mut self, id: RobotId, status: Status<Voxel>) {
        self.tell(Some(Call::Hear), &VoxelRequest::Hear(id, status));
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        let call = Some(Call::Transmit);
        let frame = self.ask(call, &VoxelRequest::Transmit, |reply| match reply {
            VoxelReply::Frame(frame) => Some(frame),
            _ => None,
        })??;
        buffer.get_mut(..frame.len())?.copy_from_slice(&frame);
        Some(frame.len())
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<u32, FrameError> {
        // What it refuses changes neither map.
        let _ = self.mirror.receive(bytes);
        let call = Some(Call::Receive);
        let heard = self.ask(call, &VoxelRequest::Receive(bytes), |reply| match reply {
            VoxelReply::Heard(heard) => Some(heard),
            _ => None,
        });
        heard.unwrap_or(Err(FrameError::Length(0)))
    }

    fn merge(&mut self, patch: &VoxelPatch) {
        self.mirror.merge(patch);
        self.tell(Some(Call::Join), &VoxelRequest::from(*patch));
    }

    fn patch(&self, tile: TileIndex, z: u8) -> VoxelPatch {
        self.mirror.patch(tile, z)
    }

    fn after(&self, tile: TileIndex, z: u8) -> (TileIndex, u8) {
        self.mirror.after(tile, z)
    }

    fn known_voxels(&self) -> u32 {
        self.mirror.known_voxels()
    }

    fn content(&self, voxel: Voxel) -> Content {
        self.mirror.content(voxel)
    }

    fn extent(&self) -> Extent {
        self.mirror.extent()
    }

    fn levels(&self) -> u8 {
        self.mirror.levels()
    }
}
