"""The public face: POST /grasp chains the stages and answers by the contract."""
