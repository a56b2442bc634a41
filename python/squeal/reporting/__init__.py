"""What scripts/report.py writes into its page."""
