"""What is odd about channels beside the same ones in other tests."""
