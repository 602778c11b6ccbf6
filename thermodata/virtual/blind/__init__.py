"""The blind benchmark on machines that nobody tuned to: strata, verdicts marked by the truth, rivals, one table."""
