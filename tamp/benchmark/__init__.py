"""Run problems x samplers x seeds for `tamp-bench`: from one case to tables and pictures."""
