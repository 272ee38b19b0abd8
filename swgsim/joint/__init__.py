"""Robot joints with a strain wave gear: recordings, textbook model, and the effects that this model lacks.

Gauges and their identification (``identification``) are not needed.
"""

from swgsim.joint.identify import JointAnswer, identify_joint, recordings_of
from swgsim.joint.intake.read import JointRecordings
from swgsim.joint.recording import JointRecording

__all__ = ["JointAnswer", "JointRecording", "JointRecordings", "identify_joint", "recordings_of"]
