"""Effects on the torque sensor and the motor current of a joint that its textbook model lacks."""
