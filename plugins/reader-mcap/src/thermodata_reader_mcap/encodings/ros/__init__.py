"""ROS messages: definitions, CDR, and many messages of one layout at once."""
