"""The knowledge-based genetic algorithm of Hu and Yang for robot path planning."""
