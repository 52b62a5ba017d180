"""The gateway over gRPC: the answers of the HTTP interface as messages of proto/sparge.proto."""
