"""What `make proto` writes from proto/sparge.proto."""
