// Answers fitting jobs with the Point Cloud Library; ../README.md says how they are written.

#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_line.h>
#include <pcl/sample_consensus/sac_model_sphere.h>

#include <chrono>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

struct Job {
    std::string primitive, file;
    int hypotheses;
    double confidence, threshold, min, max;
    std::uint32_t seed;
    Eigen::Vector3f point = Eigen::Vector3f::Zero();
};

// PCL scores a model that breaks its constraint, and counts it as an iteration. These two refuse it
// before it is scored, so that as many models are scored as in the other engines.

struct SphereModel : pcl::SampleConsensusModelSphere<pcl::PointXYZ> {
    using Base = pcl::SampleConsensusModelSphere<pcl::PointXYZ>;

    SphereModel(const Cloud::ConstPtr &cloud, const Job &job) : Base(cloud) {
        setRadiusLimits(job.min, job.max);
        rng_alg_.seed(job.seed);
    }

    bool computeModelCoefficients(const pcl::Indices &sample, Eigen::VectorXf &model) const override {
        return Base::computeModelCoefficients(sample, model) && isModelValid(model);
    }

    std::size_t countWithinDistance(const Eigen::VectorXf &model, const double threshold) const override {
        ++scored;
        return Base::countWithinDistance(model, threshold);
    }

    mutable int scored = 0;
};

struct LineModel : pcl::SampleConsensusModelLine<pcl::PointXYZ> {
    using Base = pcl::SampleConsensusModelLine<pcl::PointXYZ>;

    LineModel(const Cloud::ConstPtr &cloud, const Job &job)
        : Base(cloud), point(job.point), min(job.min), max(job.max) {
        rng_alg_.seed(job.seed);
    }

    bool computeModelCoefficients(const pcl::Indices &sample, Eigen::VectorXf &model) const override {
        if (!Base::computeModelCoefficients(sample, model)) {
            return false;
        }
        const Eigen::Vector3f offset = point - model.head<3>();
        const double distance = offset.cross(Eigen::Vector3f(model.tail<3>())).norm();
        return min <= distance && distance <= max;
    }

    std::size_t countWithinDistance(const Eigen::VectorXf &model, const double threshold) const override {
        ++scored;
        return Base::countWithinDistance(model, threshold);
    }

    mutable int scored = 0;
    Eigen::Vector3f point;
    double min, max;
};

static Cloud::Ptr read(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw std::runtime_error("cannot read " + path);
    }
    Cloud::Ptr cloud(new Cloud);
    float xyz[3];
    while (file.read(reinterpret_cast<char *>(xyz), sizeof xyz)) {
        cloud->push_back(pcl::PointXYZ(xyz[0], xyz[1], xyz[2]));
    }
    return cloud;
}

template <typename Model>
static std::string answer(const Cloud::ConstPtr &cloud, const Job &job) {
    const auto start = std::chrono::steady_clock::now();
    const auto model = pcl::make_shared<Model>(cloud, job);
    pcl::RandomSampleConsensus<pcl::PointXYZ> ransac(model, job.threshold);
    // It stops after one more than the largest number of iterations. A probability of 1 makes the
    // number that its adaptive rule asks for infinite.
    ransac.setMaxIterations(job.hypotheses - 1);
    ransac.setProbability(job.confidence > 0 ? job.confidence : 1);
    Eigen::VectorXf refined;
    if (ransac.computeModel()) {
        pcl::Indices inliers;
        Eigen::VectorXf best;
        ransac.getInliers(inliers);
        ransac.getModelCoefficients(best);
        model->optimizeModelCoefficients(inliers, best, refined);
    }
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;

    std::ostringstream out;
    out.precision(9);
    out << time.count() << ' ' << model->scored;
    for (const float coefficient : refined) {
        out << ' ' << coefficient;
    }
    return out.str();
}

int main() {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
    std::string line;
    while (std::getline(std::cin, line)) {
        std::istringstream words(line);
        Job job;
        words >> job.primitive >> job.file >> job.hypotheses >> job.confidence >> job.threshold >> job.min >> job.max
            >> job.seed;
        if (job.primitive == "line") {
            words >> job.point.x() >> job.point.y() >> job.point.z();
        }
        if (!words) {
            std::cerr << "not a job: " << line << '\n';
            return 2;
        }
        const Cloud::ConstPtr cloud = read(job.file);
        std::cout << (job.primitive == "line" ? answer<LineModel>(cloud, job) : answer<SphereModel>(cloud, job))
                  << std::endl;
    }
}
