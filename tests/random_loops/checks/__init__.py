"""What each command printed, judged."""
