//! Driving by Nav2: its action `NavigateToPose`.

use ros_messages::geometry::PoseStamped;
use ros2_client::action::{ActionClient, ActionClientQosPolicies, GoalStatusEnum};
use ros2_client::action_msgs::GoalId;
use ros2_client::{ActionTypeName, Message, Name, Node, RmwRequestId, ServiceMapping};
use serde::{Deserialize, Serialize};

use crate::node::{NodeError, reliable};

/// Where Nav2 is to go.
#[derive(Clone, Debug, Deserialize, Serialize)]
struct Goal {
    pose: PoseStamped,
    /// Empty: the one that Nav2 is configured with.
    behavior_tree: String,
}

impl Message for Goal {}

/// What is not read: results and feedback differ from release to release, and the status
/// says enough.
#[derive(Clone, Debug, Deserialize, Serialize)]
struct Unread;

impl Message for Unread {}

/// What became of the last goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// It is there.
    Arrived,
    /// It gave up, or did not take the goal.
    Refused,
}

/// The action's client, with one goal at a time.
pub(crate) struct Nav2 {
    client: ActionClient<Goal, Unread, Unread>,
    stage: Stage,
    /// Where the goal is and when it was sent, in seconds.
    sent: Option<((f64, f64), f64)>,
    /// Since when it is to stand, in seconds.
    still: Option<f64>,
}

enum Stage {
    Idle,
    /// Whether the goal is accepted is asked.
    Sent(RmwRequestId, GoalId),
    /// The result is waited for.
    Going(RmwRequestId, GoalId),
}

/// Seconds between two goals, which make Nav2 plan anew, and before it is to stand.
const PAUSE: f64 = 1.0;

impl Nav2 {
    pub(crate) fn new(
        node: &mut Node,
        action: &Name,
        mapping: ServiceMapping,
    ) -> Result<Self, NodeError> {
        let service = reliable(10);
        let policies = ActionClientQosPolicies {
            goal_service: service.clone(),
            result_service: service.clone(),
            cancel_service: service.clone(),
            feedback_subscription: service.clone(),
            status_subscription: service,
        };
        let kind = ActionTypeName::new("nav2_msgs", "NavigateToPose");
        Ok(Self {
            client: node.create_action_client(mapping, action, &kind, policies)?,
            stage: Stage::Idle,
            sent: None,
            still: None,
        })
    }

    /// Sends the robot somewhere, unless it is on its way there, or was sent somewhere just
    /// now.
    pub(crate) fn go(&mut self, pose: PoseStamped, now: f64) {
        let to = (pose.pose.position.x, pose.pose.position.y);
        self.still = None;
        if let Some((goal, at)) = self.sent
            && (goal == to || now - at < PAUSE)
        {
            return;
        }
        let goal = Goal {
            pose,
            behavior_tree: String::new(),
        };
        // A server that is not there yet is tried again.
        if let Ok((request, id)) = self.client.send_goal(goal) {
            self.stage = Stage::Sent(request, id);
            self.sent = Some((to, now));
        }
    }

    /// Lets it stand. A pause between two decisions is none.
    pub(crate) fn stay(&mut self, now: f64) {
        if now - *self.still.get_or_insert(now) >= PAUSE {
            self.cancel();
        }
    }

    /// Takes the goal back.
    pub(crate) fn cancel(&mut self) {
        if let Stage::Sent(_, goal) | Stage::Going(_, goal) = self.stage {
            let _ = self.client.cancel_goal(goal);
        }
        self.stage = Stage::Idle;
        self.sent = None;
    }

    /// What became of the goal, once.
    pub(crate) fn poll(&mut self) -> Option<Outcome> {
        // Nobody reads them; they must not pile up.
        while let Ok(Some(_)) = self.client.receive_status() {}
        let outcome = match self.stage {
            Stage::Idle => return None,
            Stage::Sent(request, goal) => {
                let response = self.client.receive_goal_response(request).ok()??;
                if response.accepted
                    && let Ok(request) = self.client.request_result(goal)
                {
                    self.stage = Stage::Going(request, goal);
                    return None;
                }
                Outcome::Refused
            }
            Stage::Going(request, _) => {
                let (status, _) = self.client.receive_result(request).ok()??;
                match status {
                    GoalStatusEnum::Succeeded => Outcome::Arrived,
                    GoalStatusEnum::Aborted => Outcome::Refused,
                    // Another goal came in between.
                    _ => return None,
                }
            }
        };
        self.stage = Stage::Idle;
        // The same place may be asked for again.
        self.sent = self.sent.filter(|_| outcome == Outcome::Refused);
        Some(outcome)
    }
}
