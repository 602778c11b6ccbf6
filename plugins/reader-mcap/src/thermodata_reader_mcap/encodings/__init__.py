"""What a message's payload holds: JSON, protobuf and ROS, one by one or many at once as columns."""
