"""Training of the network that scores grasps; never needed to run."""
