"""What lies beside the logs and says something of them: tables and lists of tests, notes, legends, sensors."""
